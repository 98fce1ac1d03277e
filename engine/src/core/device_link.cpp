#include "gravure/core/device_link.hpp"
