#include "mock_bus.hpp"

#include <fcntl.h>
#include <termios.h>
#include <umockdev.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "usbfs_handler.hpp"

namespace gravure::test {
namespace {

std::string text(const char* format, auto... values) {
  std::array<char, 512> out{};
  static_cast<void>(std::snprintf(out.data(), out.size(), format, values...));
  return out.data();
}

/// Device and configuration descriptor of docs/protocol.md (USB 2.0, 9.6), in hex.
std::string descriptors_of(const MockBus::Plug& plug) {
  const unsigned packet = plug.megabits_per_s >= 480 ? 512 : 64;
  const auto word = [](unsigned value) { return text("%02x%02x", value & 0xFFU, value >> 8U); };
  const std::string device = "12010002ff000040" + word(plug.vendor_id) + word(plug.product_id) + "0001" + "00010201";
  const std::string configuration = "0902200001010080fa";
  const std::string interface = "0904000002ff000000";
  const auto bulk = [&](unsigned endpoint) { return text("0705%02x02", endpoint) + word(packet) + "00"; };
  return device + configuration + interface + bulk(protocol::kStreamEndpoint) + bulk(protocol::kStatusEndpoint);
}

std::string description_of(const MockBus::Plug& plug, int number, const std::string& path, const std::string& node) {
  return "P: " + path + "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DRIVER=usb\nE: BUSNUM=001\n" +
         text("E: DEVNUM=%03d\nE: DEVNAME=%s\nE: MAJOR=189\nE: MINOR=%d\n", number, node.c_str(), number - 1) +
         text("E: PRODUCT=%x/%x/100\n", plug.vendor_id, plug.product_id) +
         text("A: busnum=1\\n\nA: devnum=%d\\n\nA: speed=%d\\n\n", number, plug.megabits_per_s) +
         text("A: idVendor=%04x\\n\nA: idProduct=%04x\\n\n", plug.vendor_id, plug.product_id) +
         "A: bConfigurationValue=1\\n\nA: bNumConfigurations=1\\n\nH: descriptors=" + descriptors_of(plug) + "\n";
}

}  // namespace

struct MockBus::Testbed {
  Ref<UMockdevTestbed> testbed;
};

/// umockdev does not emulate poll(), which libusb waits with. A terminal whose output is held back is not writable, and
/// one whose other end is closed has POLLERR: that is what the node of a USB device shows.
class MockBus::Device::Node {
 public:
  explicit Node(std::string path) : path_(std::move(path)), master_(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    grantpt(master_);
    unlockpt(master_);
    std::array<char, 64> name{};
    ptsname_r(master_, name.data(), name.size());
    slave_ = open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios settings{};
    tcgetattr(slave_, &settings);
    cfmakeraw(&settings);
    tcsetattr(slave_, TCSANOW, &settings);
    set_ready(false);
    std::filesystem::create_directories(std::filesystem::path(path_).parent_path());
    std::filesystem::remove(path_);
    std::filesystem::create_symlink(name.data(), path_);
  }
  ~Node() {
    hang_up();
    close(slave_);
  }
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  void set_ready(bool ready) const { tcflow(slave_, ready ? TCOON : TCOOFF); }
  void hang_up() {
    if (master_ >= 0) {
      close(std::exchange(master_, -1));
      std::filesystem::remove(path_);
    }
  }
  const std::string& path() const noexcept { return path_; }

 private:
  std::string path_;
  int master_;
  int slave_ = -1;
};

class MockBus::Device::Handler {
 public:
  Handler(Testbed& testbed, Node& node, int number, UsbBoard& board, const Plug& plug)
      : testbed_(testbed),
        node_(node),
        path_("/devices/mock/1-" + std::to_string(number)),
        endpoints_(
            board, {plug.product, plug.serial}, [this](bool ready) { node_.set_ready(ready); },
            [this] { leave_bus(); }),
        usbfs_(testbed.testbed.get(), node_name(number), endpoints_) {
    GError* error = nullptr;
    if (umockdev_testbed_add_from_string(
            testbed_.testbed.get(), description_of(plug, number, path_, node_name(number)).c_str(), &error) == FALSE) {
      std::fprintf(stderr, "mock bus: %s\n", error->message);
      std::abort();
    }
  }

  static std::string node_name(int number) { return text("/dev/bus/usb/001/%03d", number); }
  BoardEndpoints& endpoints() { return endpoints_; }

 private:
  void leave_bus() {
    const std::string path = "/sys" + path_;
    umockdev_testbed_uevent(testbed_.testbed.get(), path.c_str(), "remove");
    umockdev_testbed_remove_device(testbed_.testbed.get(), path.c_str());
    node_.hang_up();
  }

  Testbed& testbed_;
  Node& node_;
  std::string path_;
  BoardEndpoints endpoints_;
  UsbfsHandler usbfs_;
};

MockBus::Device::Device(Testbed& testbed, const std::string& root, int number, UsbBoard& board, const Plug& plug)
    : node_(std::make_unique<Node>(root + Handler::node_name(number))),
      handler_(std::make_unique<Handler>(testbed, *node_, number, board, plug)) {}

MockBus::Device::~Device() = default;

void MockBus::Device::inject(std::uint8_t endpoint, const UsbFault& fault) {
  handler_->endpoints().inject(endpoint, fault);
}

std::size_t MockBus::Device::pending_faults() {
  return handler_->endpoints().pending_faults();
}

void MockBus::Device::unplug() {
  handler_->endpoints().unplug();
}

const std::string& MockBus::Device::node_path() const noexcept {
  return node_->path();
}

Result<std::unique_ptr<MockBus>> MockBus::create() {
  static_cast<void>(std::signal(SIGHUP, SIG_IGN));  // a terminal that is closed tells the leader of a session
  auto testbed = std::make_unique<Testbed>();
  testbed->testbed.reset(umockdev_testbed_new());
  if (umockdev_in_mock_environment() == FALSE) {
    return Error{ErrorCode::device, "libumockdev-preload is not in this process"};
  }
  return std::unique_ptr<MockBus>(new MockBus(std::move(testbed)));
}

MockBus::MockBus(std::unique_ptr<Testbed> testbed) : testbed_(std::move(testbed)) {
  gchar* const root = umockdev_testbed_get_root_dir(testbed_->testbed.get());
  root_ = root;
  g_free(root);
}

MockBus::~MockBus() = default;

MockBus::Device& MockBus::plug(UsbBoard& board, const Plug& plug) {
  return *devices_.emplace_back(std::make_unique<Device>(*testbed_, root_, next_number_++, board, plug));
}

}  // namespace gravure::test
