# Finds OpenImageIO for the folder that includes this file. Debian 12's package names the include folder of OpenCV, which
# it does not depend on; CMake refuses a target with a folder that is not there, so those are taken out.
find_package(OpenImageIO QUIET REQUIRED)
foreach(target OpenImageIO::OpenImageIO OpenImageIO::OpenImageIO_Util)
  get_target_property(folders ${target} INTERFACE_INCLUDE_DIRECTORIES)
  set(found)
  foreach(folder ${folders})
    if(EXISTS ${folder})
      list(APPEND found ${folder})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${found}"
                                             INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${found}")
endforeach()
