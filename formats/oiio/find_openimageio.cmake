# Finds OpenImageIO for the folder that includes this file, as PkgConfig::OpenImageIO. Debian 12's own CMake configuration refuses to load
# without the tools, a viewer among them, that libopenimageio-dev does not depend on.
find_package(PkgConfig REQUIRED)
pkg_check_modules(OpenImageIO QUIET REQUIRED IMPORTED_TARGET OpenImageIO)
