#include <algorithm>

#include "ports.hpp"

namespace gravure::cosim {
namespace {

template <class Ports>
std::unique_ptr<Machine> make_model() {
  return std::make_unique<ModelMachine<Ports>>();
}

}  // namespace

const std::vector<Block>& all_blocks() {
  static const std::vector<Block> blocks = {
#define VARIANT(name, ...) {#name, make_model<__VA_ARGS__>},
#include "variants.def"
#undef VARIANT
  };
  return blocks;
}

const Block* find_block(const std::string& name) {
  const auto& blocks = all_blocks();
  const auto found = std::find_if(blocks.begin(), blocks.end(), [&name](const Block& b) { return b.name == name; });
  return found == blocks.end() ? nullptr : &*found;
}

}  // namespace gravure::cosim
