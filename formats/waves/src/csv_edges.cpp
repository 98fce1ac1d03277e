#include "digits.hpp"
#include "gravure/formats/waves.hpp"

namespace gravure::formats {

void append_csv_header(std::string& out) {
  out += "tick,a,b\n";
}

void append_csv_edge(std::string& out, const fpga::AbEdge& edge) {
  append_number(out, edge.clock);
  out += edge.pins.a ? ",1" : ",0";
  out += edge.pins.b ? ",1\n" : ",0\n";
}

}  // namespace gravure::formats
