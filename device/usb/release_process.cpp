#include "device/usb/release_process.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <ctime>

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace torsion::engine {
namespace {

constexpr std::size_t kMostRows = 8;
constexpr std::size_t kMostWrites = 2;

struct LastWrite {
  std::uint8_t endpoint = 0;
  std::uint8_t interface = 0;  // that has it
  std::uint16_t length = 0;
  std::array<std::uint8_t, kLargestUsbWrite> bytes{};
};

/// What crosses the socket.
struct Entry {
  std::uint32_t row = 0;
  std::uint32_t writes = 0;  // 0: forget it
  std::uint8_t bus = 0;
  std::uint8_t address = 0;
  std::array<LastWrite, kMostWrites> last{};
};

/// What the process has in hand of one device.
struct Watched {
  int node = -1;
  Entry entry;
};

// From here to the end of run(): between a fork and the end only what a signal handler may call,
// since a lock that another thread of the program held at the fork stays held for ever.

void take_entry(std::array<Watched, kMostRows>& devices, const Entry& entry) {
  Watched& device = devices[std::min<std::size_t>(entry.row, kMostRows - 1)];
  if (device.node >= 0) {
    ::close(device.node);
    device.node = -1;
  }
  device.entry = entry;
  if (entry.writes == 0) {
    return;
  }
  // "/dev/bus/usb/001/002"
  std::array<char, 24> path{"/dev/bus/usb/000/000"};
  const auto put = [&path](std::size_t at, unsigned number) {
    for (std::size_t digit = 3; digit-- > 0; number /= 10) {
      path[at + digit] = static_cast<char>('0' + number % 10);
    }
  };
  put(13, entry.bus);
  put(17, entry.address);
  device.node = ::open(path.data(), O_RDWR | O_CLOEXEC);
}

/// The program's claims end with its open files, which may be a moment after its socket.
bool claim(int node, unsigned interface) {
  constexpr int kTries = 200;
  constexpr timespec kBetweenTries{0, 200000};  // ns: 40 ms in all
  for (int i = 0; i < kTries; ++i) {
    if (::ioctl(node, USBDEVFS_CLAIMINTERFACE, &interface) == 0) {
      return true;
    }
    if (errno != EBUSY) {
      return false;
    }
    ::nanosleep(&kBetweenTries, nullptr);
  }
  return false;
}

void let_go(const Watched& device) {
  constexpr unsigned kReleaseTimeout = 50;  // ms
  for (std::uint32_t i = 0; i < device.entry.writes && device.node >= 0; ++i) {
    LastWrite last = device.entry.last[i];
    if (claim(device.node, last.interface)) {
      usbdevfs_bulktransfer transfer{last.endpoint, last.length, kReleaseTimeout,
                                     last.bytes.data()};
      ::ioctl(device.node, USBDEVFS_BULK, &transfer);  // of an interrupt endpoint, too
      unsigned interface = last.interface;
      ::ioctl(device.node, USBDEVFS_RELEASEINTERFACE, &interface);
    }
  }
}

void close_all_but(int kept) {
  const auto number = static_cast<unsigned>(kept);
  if (number > 3) {
    ::close_range(3, number - 1, 0);
  }
  ::close_range(std::max(3U, number + 1), ~0U, 0);
}

[[noreturn]] void run(int socket) {
  ::setsid();  // what ends the program's terminal or group does not end this
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    ::signal(signal, SIG_IGN);  // NOLINT(cert-err33-c): there is nobody to tell
  }
  ::prctl(PR_SET_NAME, "torsion-release");
  close_all_but(socket);
  std::array<Watched, kMostRows> devices{};
  Entry entry;
  while (true) {
    const ssize_t size = ::read(socket, &entry, sizeof entry);
    if (size == static_cast<ssize_t>(sizeof entry)) {
      take_entry(devices, entry);
    } else if (size == 0) {
      break;
    } else if (size > 0 || errno != EINTR) {
      ::_exit(1);
    }
  }
  for (const Watched& device : devices) {
    let_go(device);
  }
  ::_exit(0);
}

std::uint8_t interface_with(const UsbIdentity& identity, std::uint8_t endpoint) {
  for (const UsbInterface& interface : identity.interfaces) {
    if (std::ranges::any_of(interface.endpoints, [endpoint](const UsbEndpoint& one) {
          return one.address == endpoint;
        })) {
      return interface.number;
    }
  }
  return 0;
}

void tell(int socket, const Entry& entry) {
  // It is never full: a device comes and goes seldom. Without the other process, which somebody may
  // have killed, this program goes on alone.
  static_cast<void>(::send(socket, &entry, sizeof entry, MSG_DONTWAIT | MSG_NOSIGNAL));
}

}  // namespace

std::unique_ptr<ReleaseProcess> ReleaseProcess::start() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return nullptr;
  }
  const pid_t process = ::fork();
  if (process == 0) {
    ::close(ends[1]);
    run(ends[0]);
  }
  ::close(ends[0]);
  if (process < 0) {
    ::close(ends[1]);
    return nullptr;
  }
  return std::unique_ptr<ReleaseProcess>(new ReleaseProcess(ends[1], process));
}

ReleaseProcess::~ReleaseProcess() {
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  ::close(socket_);
}

void ReleaseProcess::look_after(std::size_t row, const UsbIdentity& identity,
                                const UsbRequests& last) const {
  Entry entry;
  entry.row = static_cast<std::uint32_t>(row);
  entry.bus = identity.bus;
  entry.address = identity.address;
  for (std::size_t i = 0; i < last.count && entry.writes < kMostWrites; ++i) {
    const UsbRequest& request = last.rows[i];
    if (request.job == UsbJob::kWrite) {
      LastWrite& write = entry.last[entry.writes++];
      write.endpoint = request.endpoint;
      write.interface = interface_with(identity, request.endpoint);
      write.length = request.length;
      write.bytes = request.bytes;
    }
  }
  if (entry.writes > 0) {
    tell(socket_, entry);
  }
}

void ReleaseProcess::forget(std::size_t row) const {
  Entry entry;
  entry.row = static_cast<std::uint32_t>(row);
  tell(socket_, entry);
}

}  // namespace torsion::engine
