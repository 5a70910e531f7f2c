#include "device/gateway/datagram_socket.hpp"

#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/stat.h>
#include <sys/un.h>

namespace torsion::engine {

Error unusable_socket(const std::string& where) {
  return Error{fmt::format("--device {}: {}; choose another address", where,
                           std::strerror(errno))};  // NOLINT(concurrency-mt-unsafe): at start
}

Result<Descriptor> open_udp(std::uint16_t port) {
  Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);  // nobody else can reach it
  if (socket.number() < 0 ||
      ::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address),  // NOLINT
             sizeof address) != 0) {
    return unusable_socket(fmt::format("gateway:{}", port));
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
  sockaddr_in bound{};
  socklen_t length = sizeof bound;
  const int failed = ::getsockname(socket.number(), reinterpret_cast<sockaddr*>(&bound),  // NOLINT
                                   &length);
  return failed == 0 && bound.sin_family == AF_INET ? ntohs(bound.sin_port) : std::uint16_t{0};
}

}  // namespace torsion::engine
