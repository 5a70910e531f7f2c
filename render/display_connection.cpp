#include "render/display_connection.hpp"

#include <sys/socket.h>

// Last: X11 defines macros with names that others use.
#define GLFW_INCLUDE_NONE
#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3.h>
#include <GLFW/glfw3native.h>

namespace torsion::engine {

void send_pictures_in_pieces() {
  // Bytes; the kernel takes twice as much, for its own. Between 16 KiB, which cost a tenth of the
  // pictures, and 96 KiB, with which as many steps were late as with the 208 KiB that Linux gives.
  constexpr int kUnderWay = 48 * 1024;
  Display* const display = ::glfwGetX11Display();
  if (display == nullptr) {
    return;
  }
  const int socket = ConnectionNumber(display);
  int family = 0;
  socklen_t size = sizeof family;
  if (::getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &family, &size) == 0 && family == AF_UNIX) {
    ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kUnderWay, sizeof kUnderWay);
  }
}

}  // namespace torsion::engine
