#include "hdf5_channel.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <span>
#include <utility>

#include "heap_check.hpp"

namespace gravure::grv {

void Hdf5Channel::watch(const void* buffer) noexcept {
  watched_ = buffer;
  watched_offset_.reset();
}

bool Hdf5Channel::read(std::uint64_t offset, void* buffer, std::size_t bytes) noexcept {
  auto got = file_->read(offset, {static_cast<std::byte*>(buffer), bytes});
  if (!got) {
    failure_ = got.error();
    return false;
  }
  // Drivers give zeros beyond the end: the library may have reserved space that it has not written yet.
  std::memset(static_cast<std::byte*>(buffer) + got.value(), 0, bytes - got.value());
  return true;
}

void Hdf5Channel::write(std::uint64_t offset, const void* buffer, std::size_t bytes) noexcept {
  if (buffer == watched_) {
    watched_offset_ = offset;
  }
  if (!abandoned_) {
    settle(file_->write(offset, {static_cast<const std::byte*>(buffer), bytes}));
  }
}

void Hdf5Channel::resize(std::uint64_t bytes) noexcept {
  if (!abandoned_) {
    settle(file_->resize(bytes));
  }
}

void Hdf5Channel::settle(const Result<void>& done) noexcept {
  if (!done) {
    failure_ = done.error();
    abandoned_ = true;
  }
}

namespace {

constexpr haddr_t kMaxAddress = (haddr_t{1} << 62) - 1;

/// What the library keeps for an open file; it fills in the fields of H5FD_t.
struct OpenFile : H5FD_t {
  std::shared_ptr<Hdf5Channel> channel;
  haddr_t end_of_allocation = 0;
  haddr_t end_of_file = 0;
  bool reading = false;
};

/// Passed through the property list, which copies it.
struct DriverInfo {
  const std::shared_ptr<Hdf5Channel>* channel;
};

OpenFile& opened(H5FD_t* file) {
  return *static_cast<OpenFile*>(file);
}

H5FD_t* driver_open(const char* /*name*/, unsigned flags, hid_t access, haddr_t /*max_address*/) {
  const auto* info = static_cast<const DriverInfo*>(H5Pget_driver_info(access));
  if (info == nullptr) {
    return nullptr;
  }
  auto size = (*info->channel)->file().size();
  if (!size) {
    return nullptr;
  }
  auto* file = new (std::nothrow) OpenFile();
  if (file != nullptr) {
    file->channel = *info->channel;
    file->end_of_file = size.value();
    file->reading = (flags & H5F_ACC_RDWR) == 0;
  }
  return file;
}

herr_t driver_close(H5FD_t* file) {
  delete static_cast<OpenFile*>(file);
  return 0;
}

/// When reading, the library's accumulator of metadata is left out: HDF5 1.10.8 asks it for undefined addresses without
/// a look at them, and crashes, where this driver says no.
herr_t driver_query(const H5FD_t* file, unsigned long* features) {
  const bool reading = file != nullptr && static_cast<const OpenFile*>(file)->reading;
  *features =
      H5FD_FEAT_DEFAULT_VFD_COMPATIBLE | (reading ? 0U : H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA);
  return 0;
}

haddr_t driver_end_of_allocation(const H5FD_t* file, H5FD_mem_t /*type*/) {
  return static_cast<const OpenFile*>(file)->end_of_allocation;
}

herr_t driver_set_end_of_allocation(H5FD_t* file, H5FD_mem_t /*type*/, haddr_t address) {
  opened(file).end_of_allocation = address;
  return 0;
}

haddr_t driver_end_of_file(const H5FD_t* file, H5FD_mem_t /*type*/) {
  return static_cast<const OpenFile*>(file)->end_of_file;
}

bool inside(haddr_t address, std::size_t bytes) {
  return address <= kMaxAddress && bytes <= kMaxAddress - address;
}

herr_t driver_read(H5FD_t* file, H5FD_mem_t type, hid_t /*transfer*/, haddr_t address, std::size_t bytes,
                   void* buffer) {
  Hdf5Channel& channel = *opened(file).channel;
  if (!inside(address, bytes) || !channel.read(address, buffer, bytes)) {
    return -1;
  }
  if (!opened(file).reading || type != H5FD_MEM_LHEAP) {
    return 0;
  }
  try {
    return heap_is_sound(channel.file(), {static_cast<const std::byte*>(buffer), bytes}) ? 0 : -1;
  } catch (const std::bad_alloc&) {  // C code is above
    return -1;
  }
}

herr_t driver_write(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address, std::size_t bytes,
                    const void* buffer) {
  if (!inside(address, bytes)) {
    return -1;
  }
  opened(file).channel->write(address, buffer, bytes);
  opened(file).end_of_file = std::max<haddr_t>(opened(file).end_of_file, address + bytes);
  return 0;
}

herr_t driver_truncate(H5FD_t* file, hid_t /*transfer*/, hbool_t /*closing*/) {
  OpenFile& open = opened(file);
  if (open.end_of_allocation != open.end_of_file) {
    open.channel->resize(open.end_of_allocation);
    open.end_of_file = open.end_of_allocation;
  }
  return 0;
}

H5FD_class_t make_driver() {
  H5FD_class_t driver = {};
  driver.name = "gravure";
  driver.maxaddr = kMaxAddress;
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(DriverInfo);
  driver.open = driver_open;
  driver.close = driver_close;
  driver.query = driver_query;
  driver.get_eoa = driver_end_of_allocation;
  driver.set_eoa = driver_set_end_of_allocation;
  driver.get_eof = driver_end_of_file;
  driver.read = driver_read;
  driver.write = driver_write;
  driver.truncate = driver_truncate;
  constexpr H5FD_mem_t kMap[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(kMap), std::end(kMap), std::begin(driver.fl_map));
  return driver;
}

}  // namespace

bool set_channel(hid_t access, const std::shared_ptr<Hdf5Channel>& channel) {
  static const H5FD_class_t driver = make_driver();  // the library keeps a pointer to it
  static hid_t id = H5I_INVALID_HID;
  if (H5Iis_valid(id) <= 0) {  // first use, or the library was shut down in between
    id = H5FDregister(&driver);
  }
  const DriverInfo info{&channel};
  return id >= 0 && H5Pset_driver(access, id, &info) >= 0;
}

}  // namespace gravure::grv
