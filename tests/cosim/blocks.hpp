#pragma once

#include "blocks_axis.hpp"
#include "blocks_host.hpp"
#include "blocks_lines.hpp"

/// For every block: its model, and its ports in order. The visitor takes (name, member, width); the same list serves
/// the model's structs and the members of the class that Verilator makes.
