#include "usbfs_handler.hpp"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

namespace gravure::test {
namespace {

constexpr std::size_t kUrbBytes = 56;  // sizeof is pedantic about the flexible array at its end
static_assert(offsetof(usbdevfs_urb, usercontext) + sizeof(void*) == kUrbBytes, "of the 64-bit kernel");
constexpr guint32 kCapabilities = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION |
                                  USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_BULK_SCATTER_GATHER |
                                  USBDEVFS_CAP_REAP_AFTER_DISCONNECT;

/// Counts handlers: an edge from the thread that makes one to umockdev's, which ThreadSanitizer does not see in GLib.
std::atomic<int> handlers_made{0};

/// A transfer's memory at the caller.
struct CallerMemory {
  Ref<UMockdevIoctlData> urb;
  Ref<UMockdevIoctlData> buffer;
};

Ref<UMockdevIoctlData> resolve(UMockdevIoctlData* pointer, std::size_t offset, std::size_t size) {
  return Ref<UMockdevIoctlData>(umockdev_ioctl_data_resolve(pointer, offset, size, nullptr));
}

template <class T>
T value_at(UMockdevIoctlData* pointer) {
  T value{};
  const auto data = resolve(pointer, 0, sizeof(T));
  if (data) {
    std::memcpy(&value, data->data, sizeof(T));
  }
  return value;
}

std::span<std::byte> bytes_of(const Ref<UMockdevIoctlData>& data) {
  return data ? std::as_writable_bytes(std::span(data->data, static_cast<std::size_t>(data->data_len)))
              : std::span<std::byte>();
}

}  // namespace

UsbfsHandler::UsbfsHandler(UMockdevTestbed* testbed, std::string device_node, BoardEndpoints& endpoints)
    : testbed_(testbed), device_node_(std::move(device_node)), endpoints_(endpoints), base_(umockdev_ioctl_base_new()) {
  g_signal_connect(base_.get(), "handle-ioctl", reinterpret_cast<GCallback>(&UsbfsHandler::on_ioctl), this);
  g_signal_connect(base_.get(), "client-vanished", reinterpret_cast<GCallback>(&UsbfsHandler::on_vanished), this);
  handlers_made.fetch_add(1, std::memory_order_release);
  umockdev_testbed_attach_ioctl(testbed_, device_node_.c_str(), base_.get(), nullptr);
}

UsbfsHandler::~UsbfsHandler() {
  umockdev_testbed_detach_ioctl(testbed_, device_node_.c_str(), nullptr);
}

gboolean UsbfsHandler::on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
  static_cast<void>(handlers_made.load(std::memory_order_acquire));
  const int error = static_cast<UsbfsHandler*>(self)->handle(client);
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
  return TRUE;
}

void UsbfsHandler::on_vanished(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, gpointer self) {
  static_cast<UsbfsHandler*>(self)->endpoints_.forget(client);
}

int UsbfsHandler::handle(UMockdevIoctlClient* client) {
  UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
  const auto request = static_cast<guint32>(umockdev_ioctl_client_get_request(client));
  if (request == USBDEVFS_REAPURBNDELAY || request == USBDEVFS_REAPURB) {
    return reap(client, argument);
  }
  if (request == USBDEVFS_DISCARDURB) {
    guint64 address = 0;
    std::memcpy(&address, argument->data, sizeof address);
    return endpoints_.discard(client, address);
  }
  if (endpoints_.unplugged()) {
    return ENODEV;
  }
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES: {
      const auto answer = resolve(argument, 0, sizeof kCapabilities);
      std::memcpy(answer->data, &kCapabilities, sizeof kCapabilities);
      return 0;
    }
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_DISCONNECT_CLAIM:
      return endpoints_.claim(client);
    case USBDEVFS_RELEASEINTERFACE:
      return endpoints_.release(client);
    case USBDEVFS_SUBMITURB:
      return submit(client, argument);
    case USBDEVFS_CLEAR_HALT:
      return endpoints_.clear_halt(static_cast<std::uint8_t>(value_at<guint32>(argument)));
    case USBDEVFS_GETDRIVER:
    case USBDEVFS_IOCTL:
      return ENODATA;  // no driver of the system has it
    case USBDEVFS_SETINTERFACE:
    case USBDEVFS_SETCONFIGURATION:
    case USBDEVFS_RESET:
      return 0;
    default:
      return ENOTTY;
  }
}

int UsbfsHandler::submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  auto memory = std::make_shared<CallerMemory>();
  memory->urb = resolve(argument, 0, kUrbBytes);
  if (!memory->urb) {
    return EFAULT;
  }
  const auto* const asked = reinterpret_cast<const usbdevfs_urb*>(memory->urb->data);
  const auto size = static_cast<std::size_t>(asked->buffer_length);
  Urb urb;
  urb.client = client;
  urb.address = memory->urb->client_addr;
  urb.endpoint = asked->type == USBDEVFS_URB_TYPE_CONTROL ? std::uint8_t{0} : asked->endpoint;
  memory->buffer = resolve(memory->urb.get(), offsetof(usbdevfs_urb, buffer), size);
  std::span<const std::byte> data = bytes_of(memory->buffer);
  if (urb.endpoint == 0) {
    if (data.size() < protocol::kSetupBytes) {
      return EINVAL;
    }
    urb.setup = protocol::decode_setup(data.first<protocol::kSetupBytes>());
    data = data.subspan(protocol::kSetupBytes);
  }
  urb.length = data.size();
  urb.data.assign(data.begin(), data.end());
  urb.memory = std::move(memory);
  return endpoints_.submit(std::move(urb));
}

int UsbfsHandler::reap(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  std::optional<Urb> urb = endpoints_.reap(client);
  if (!urb) {
    return endpoints_.unplugged() ? ENODEV : EAGAIN;
  }
  const auto& memory = *static_cast<const CallerMemory*>(urb->memory.get());
  auto* const answer = reinterpret_cast<usbdevfs_urb*>(memory.urb->data);
  answer->status = urb->status;
  answer->actual_length = static_cast<int>(urb->actual);
  const bool to_host = (urb->endpoint == 0 ? urb->setup.request_type : urb->endpoint) >= 0x80U;
  if (to_host && memory.buffer) {
    const auto room = bytes_of(memory.buffer).subspan(urb->endpoint == 0 ? protocol::kSetupBytes : 0);
    std::copy_n(urb->data.begin(), std::min({urb->actual, urb->data.size(), room.size()}), room.begin());
  }
  const auto pointer = resolve(argument, 0, sizeof(void*));
  umockdev_ioctl_data_set_ptr(pointer.get(), 0, memory.urb.get());
  return 0;
}

}  // namespace gravure::test
