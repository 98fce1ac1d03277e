#pragma once

#include <memory>

#include "byte_file.hpp"
#include "gravure/core/error.hpp"
#include "gravure/core/program.hpp"
#include "gravure/formats/grv.hpp"

namespace gravure::grv {

/// open_grv_part() from any bytes.
Result<GrvPart> open_part(std::unique_ptr<ByteFile> file);
/// open_grv() from any bytes.
Result<std::unique_ptr<LineSource>> open_program(std::unique_ptr<ByteFile> file);

}  // namespace gravure::grv
