// ThreadSanitizer sees no locks in libraries that were not built with it: what GLib and umockdev, the emulated side of
// the bus, do among themselves is no news. libusb hands a new transfer to its other thread by way of the system, which
// first touches the transfer's lock. All else of ours and of libusb's is looked at.

extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
  return "race_top:pthread_mutex_lock\n"
         "called_from_lib:libglib-2.0.so\n"
         "called_from_lib:libgobject-2.0.so\n"
         "called_from_lib:libgio-2.0.so\n"
         "called_from_lib:libumockdev.so\n"
         "called_from_lib:libumockdev-preload.so\n"
         "called_from_lib:libudev.so\n";
}
