#include "device/gateway/datagram_socket.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <netdb.h>
#include <sys/stat.h>
#include <sys/un.h>

namespace torsion::engine {

Error unusable_socket(const std::string& where) {
  return Error{fmt::format("--device {}: {}; choose another address", where,
                           std::strerror(errno))};  // NOLINT(concurrency-mt-unsafe): at start
}

Result<Descriptor> open_udp(const std::string& address, std::uint16_t port) {
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  addrinfo* found = nullptr;
  if (::getaddrinfo(address.c_str(), std::to_string(port).c_str(), &wanted, &found) != 0) {
    return Error{
        fmt::format("--gateway-address {}: expected an address of this machine in numbers, "
                    "as ip addr lists them, or 0.0.0.0 for all of them",
                    address)};
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, ::freeaddrinfo);
  Descriptor socket(::socket(found->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.number() < 0 || ::bind(socket.number(), found->ai_addr, found->ai_addrlen) != 0) {
    return unusable_socket(fmt::format("gateway:{}, {}", port, address));
  }
  return socket;
}

Result<Descriptor> open_unix(const std::filesystem::path& path) {
  const std::string where = "gateway:" + path.string();
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.string().size() >= sizeof address.sun_path) {
    return Error{fmt::format("--device {}: the path is longer than the {} bytes of a socket's",
                             where, sizeof address.sun_path - 1)};
  }
  std::strcpy(address.sun_path, path.c_str());
  std::error_code error;
  if (std::filesystem::is_socket(path, error)) {
    std::filesystem::remove(path, error);  // left by a run that was killed
  }
  Descriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.number() < 0 ||
      ::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address),  // NOLINT
             sizeof address) != 0 ||
      ::chmod(path.c_str(), S_IRUSR | S_IWUSR) != 0) {
    return unusable_socket(where);
  }
  return socket;
}

std::uint16_t port_of(const Descriptor& socket) {
  Address bound;
  bound.length = sizeof bound.storage;
  if (::getsockname(socket.number(), reinterpret_cast<sockaddr*>(&bound.storage),  // NOLINT
                    &bound.length) != 0) {
    return 0;
  }
  std::array<char, NI_MAXSERV> port{};
  if (::getnameinfo(bound.get(), bound.length, nullptr, 0, port.data(), port.size(),
                    NI_NUMERICSERV | NI_DGRAM) != 0) {
    return 0;
  }
  return static_cast<std::uint16_t>(std::strtoul(port.data(), nullptr, 10));
}

}  // namespace torsion::engine
