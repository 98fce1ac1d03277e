#include <array>
#include <utility>

#include "gravure/formats/waves.hpp"

namespace gravure::formats {

Result<VcdWriter> VcdWriter::make(const VcdTime& time) {
  GRAVURE_TRY(WaveDump dump, WaveDump::make(time, "ab", {{.name = "a"}, {.name = "b"}}));
  return VcdWriter(std::move(dump));
}

Result<void> VcdWriter::begin(std::string& out, std::uint64_t first, fpga::AbPins pins) {
  const std::array<std::uint64_t, 2> values = {pins.a ? 1U : 0U, pins.b ? 1U : 0U};
  return dump_.begin(out, first, values);
}

Result<void> VcdWriter::edge(std::string& out, const fpga::AbEdge& edge) {
  GRAVURE_CHECK(dump_.change(out, edge.clock, 0, edge.pins.a ? 1 : 0));
  return dump_.change(out, edge.clock, 1, edge.pins.b ? 1 : 0);
}

Result<void> VcdWriter::end(std::string& out, std::uint64_t last) {
  return dump_.end(out, last);
}

}  // namespace gravure::formats
