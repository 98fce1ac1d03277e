#pragma once

#include <umockdev.h>

#include <memory>
#include <string>

#include "board_endpoints.hpp"

namespace gravure::test {

struct Unref {
  void operator()(void* object) const noexcept { g_object_unref(object); }
};
template <class T>
using Ref = std::unique_ptr<T, Unref>;

/// The ioctls of usbdevfs (<linux/usbdevice_fs.h>) on one node, in terms of endpoints. Memory of the caller is read and
/// written by way of umockdev, so that it may be another process.
class UsbfsHandler {
 public:
  UsbfsHandler(UMockdevTestbed* testbed, std::string device_node, BoardEndpoints& endpoints);
  ~UsbfsHandler();
  UsbfsHandler(const UsbfsHandler&) = delete;
  UsbfsHandler& operator=(const UsbfsHandler&) = delete;

 private:
  static gboolean on_ioctl(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
  static void on_vanished(UMockdevIoctlBase* base, UMockdevIoctlClient* client, gpointer self);
  /// An errno; 0: done.
  int handle(UMockdevIoctlClient* client);
  int submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  int reap(UMockdevIoctlClient* client, UMockdevIoctlData* argument);

  UMockdevTestbed* testbed_;
  std::string device_node_;
  BoardEndpoints& endpoints_;
  Ref<UMockdevIoctlBase> base_;
};

}  // namespace gravure::test
