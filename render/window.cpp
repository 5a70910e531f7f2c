#include "render/window.hpp"

#include <cstdlib>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "render/display_connection.hpp"

namespace torsion::engine {

struct Window::Impl {
  GLFWwindow* window = nullptr;
  WindowInput input;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  Impl(Impl&&) = delete;
  Impl& operator=(Impl&&) = delete;
  ~Impl() {
    if (window != nullptr) {
      ::glfwDestroyWindow(window);
    }
    ::glfwTerminate();
  }
};

namespace {

WindowInput& input_of(GLFWwindow* window) {
  return *static_cast<WindowInput*>(::glfwGetWindowUserPointer(window));
}

void on_wheel(GLFWwindow* window, double /*x*/, double y) {
  input_of(window).wheel += y;
}

void on_key(GLFWwindow* window, int key, int /*scancode*/, int action, int /*mods*/) {
  if (action == GLFW_PRESS) {
    input_of(window).pressed.push_back(key);
  }
}

bool either(GLFWwindow* window, int left, int right) {
  return ::glfwGetKey(window, left) == GLFW_PRESS || ::glfwGetKey(window, right) == GLFW_PRESS;
}

std::string last_error() {
  const char* text = nullptr;
  ::glfwGetError(&text);
  return text == nullptr ? "" : text;
}

/// Where the mouse is in the window and on the desktop. The window may move between two questions
/// about it, then they are asked again.
void read_mouse(GLFWwindow* window, WindowInput& input) {
  constexpr int kTries = 3;
  int left = 0;
  int top = 0;
  ::glfwGetWindowPos(window, &left, &top);
  for (int i = 0; i < kTries; ++i) {
    const int left_before = left;
    const int top_before = top;
    ::glfwGetCursorPos(window, &input.mouse_x, &input.mouse_y);
    ::glfwGetWindowPos(window, &left, &top);
    if (left == left_before && top == top_before) {
      break;
    }
  }
  input.desk_x = left + input.mouse_x;
  input.desk_y = top + input.mouse_y;
}

/// Mouse and size in pixels of the picture, which on some desktops are not those of the window.
void read_place(GLFWwindow* window, WindowInput& input) {
  int width = 0;
  int height = 0;
  int pixels_x = 0;
  int pixels_y = 0;
  ::glfwGetWindowSize(window, &width, &height);
  ::glfwGetFramebufferSize(window, &pixels_x, &pixels_y);
  read_mouse(window, input);
  if (width > 0 && height > 0) {
    const double scale_x = static_cast<double>(pixels_x) / width;
    const double scale_y = static_cast<double>(pixels_y) / height;
    input.mouse_x *= scale_x;
    input.mouse_y *= scale_y;
    input.desk_x *= scale_x;
    input.desk_y *= scale_y;
  }
  input.width = static_cast<std::uint32_t>(pixels_x);
  input.height = static_cast<std::uint32_t>(pixels_y);
  input.hidden =
      ::glfwGetWindowAttrib(window, GLFW_ICONIFIED) != 0 || pixels_x == 0 || pixels_y == 0;
}

}  // namespace

Result<Window> Window::open(const std::string& title, std::uint32_t width, std::uint32_t height) {
  if (::glfwInit() != GLFW_TRUE) {
    return Error{"No window can be opened: " + last_error() +
                 " (without a display, torsion render draws into files)."};
  }
  auto impl = std::make_unique<Impl>();  // from here on it ends what glfwInit began
  send_pictures_in_pieces();
  if (::glfwVulkanSupported() != GLFW_TRUE) {
    return Error{
        "No window can be opened: the Vulkan loader or a driver for windows is missing "
        "(package mesa-vulkan-drivers)."};
  }
  ::glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  impl->window = ::glfwCreateWindow(static_cast<int>(width), static_cast<int>(height),
                                    title.c_str(), nullptr, nullptr);
  if (impl->window == nullptr) {
    return Error{"No window can be opened: " + last_error() + "."};
  }
  ::glfwSetWindowUserPointer(impl->window, &impl->input);
  ::glfwSetScrollCallback(impl->window, on_wheel);
  ::glfwSetKeyCallback(impl->window, on_key);
  // A click between two looks must not be lost.
  ::glfwSetInputMode(impl->window, GLFW_STICKY_MOUSE_BUTTONS, GLFW_TRUE);
  return Window(std::move(impl));
}

Window::Window(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Window::Window(Window&&) noexcept = default;
Window& Window::operator=(Window&&) noexcept = default;
Window::~Window() = default;

const WindowInput& Window::look(double wait) {
  GLFWwindow* const window = impl_->window;
  WindowInput& input = impl_->input;
  input.wheel = 0.0;
  input.pressed.clear();
  if (wait > 0.0) {
    ::glfwWaitEventsTimeout(wait);
  } else {
    ::glfwPollEvents();
  }
  read_place(window, input);
  for (std::size_t button = 0; button < input.buttons.size(); ++button) {
    input.buttons[button] = ::glfwGetMouseButton(window, static_cast<int>(button)) == GLFW_PRESS;
  }
  input.shift = either(window, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  input.alt = either(window, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
  input.control = either(window, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
  input.close = ::glfwWindowShouldClose(window) != 0;
  return input;
}

const WindowInput& Window::input() const {
  return impl_->input;
}

void Window::set_title(const std::string& title) {
  ::glfwSetWindowTitle(impl_->window, title.c_str());
}

void* Window::handle() const {
  return impl_->window;
}

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nothing sets it
    if (value != nullptr && *value != '\0') {
      return true;
    }
  }
  return false;
}

}  // namespace torsion::engine
