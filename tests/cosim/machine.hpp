#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gravure::cosim {

struct Port {
  std::string name;
  int width = 1;
  std::uint64_t mask() const { return ~std::uint64_t{0} >> static_cast<unsigned>(64 - width); }
};

/// A clocked block with numbered ports: the C++ model or the Verilog under a simulator, seen alike.
class Machine {
 public:
  virtual ~Machine() = default;
  virtual const std::vector<Port>& inputs() const = 0;
  virtual const std::vector<Port>& outputs() const = 0;
  /// One rising clock edge with these inputs; fills in the outputs as they stand just after it.
  virtual void step(std::span<const std::uint64_t> in, std::span<std::uint64_t> out) = 0;
};

/// A block at one choice of its parameters, for example "ab_generator_6".
struct Block {
  std::string name;
  std::unique_ptr<Machine> (*model)();
};
/// Every block there is.
const std::vector<Block>& all_blocks();
const Block* find_block(const std::string& name);

/// The block's Verilog under Verilator.
std::unique_ptr<Machine> make_rtl(const std::string& name);

}  // namespace gravure::cosim
