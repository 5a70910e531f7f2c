#pragma once

// Sockets of this machine that take packets, for the gateway.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include <sys/socket.h>
#include <unistd.h>

#include "ecs/result.hpp"

namespace torsion::engine {

/// A file descriptor of its own.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) {
      ::close(number_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

/// Where a client is.
struct Address {
  sockaddr_storage storage{};
  socklen_t length = 0;

  [[nodiscard]] const sockaddr* get() const {
    return reinterpret_cast<const sockaddr*>(&storage);  // NOLINT: as the sockets' interface is
  }
};

/// Why a socket cannot be there, from errno.
/// @param where  as the command line says it
Error unusable_socket(const std::string& where);

/// Takes packets to this port. 0: any free one.
/// @param address  of this machine, as numbers: "127.0.0.1" or "::1", which no other one reaches;
///                 "0.0.0.0" or "::" is every one that it has
Result<Descriptor> open_udp(const std::string& address, std::uint16_t port);

/// Takes packets to this path, only the user's. What a run that was killed left there goes.
Result<Descriptor> open_unix(const std::filesystem::path& path);

/// The port of a UDP socket; 0 of any other.
std::uint16_t port_of(const Descriptor& socket);

}  // namespace torsion::engine
