# Debian's shared HDF5 loads 36 libraries for files in the cloud (curl, Kerberos, LDAP), which costs every verb 8 ms before it begins. The archive
# beside it needs two: where it links, our build takes it. Who uses our libraries from outside chooses for himself.
include(CheckCSourceCompiles)
get_target_property(hdf5_shared hdf5::hdf5 IMPORTED_LOCATION)
string(REGEX REPLACE "[.]so$" ".a" hdf5_archive "${hdf5_shared}")
if(hdf5_archive MATCHES "[.]a$" AND EXISTS "${hdf5_archive}")
  set(hdf5_archive_needs sz z ${CMAKE_DL_LIBS} m)
  set(CMAKE_REQUIRED_INCLUDES ${HDF5_INCLUDE_DIRS})
  set(CMAKE_REQUIRED_LIBRARIES ${hdf5_archive} ${hdf5_archive_needs})
  check_c_source_compiles("#include <hdf5.h>
int main(void) { return H5open(); }" GRAVURE_HDF5_ARCHIVE_LINKS)
  unset(CMAKE_REQUIRED_INCLUDES)
  unset(CMAKE_REQUIRED_LIBRARIES)
  if(GRAVURE_HDF5_ARCHIVE_LINKS)
    set_target_properties(hdf5::hdf5 PROPERTIES IMPORTED_LOCATION ${hdf5_archive} INTERFACE_LINK_LIBRARIES "${hdf5_archive_needs}")
  endif()
endif()
