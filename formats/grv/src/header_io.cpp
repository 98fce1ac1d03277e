#include "header_io.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>
#include <variant>

#include "gravure/formats/plan_json.hpp"
#include "hdf5_data.hpp"
#include "hdf5_session.hpp"
#include "header_check.hpp"
#include "set_point_table.hpp"
#include "source_table.hpp"

namespace gravure::grv {
namespace {

constexpr const char* kFormat = "gravure program";
constexpr const char* kSources = "sources";
constexpr const char* kFiles = "files";
constexpr const char* kBitsOfLayer = "bits_of_layer";
constexpr const char* kUnits =
    "time in FPGA ticks (clock_multiplier per seed pulse) or pulse slots; length and frequency as the names say; "
    "bits packed 8 to a byte, most significant first, in time order, 1 fires";

Result<void> write_plan(hid_t file, const Plan& plan) {
  GRAVURE_TRY(const Handle dataset, write_text(file, "plan", plan_to_json(plan)));
  for (const PlanNumber& number : plan_numbers(plan)) {
    GRAVURE_CHECK(
        std::visit([&](auto value) { return write_attribute(dataset.get(), number.name, value); }, number.value));
    GRAVURE_CHECK(write_text_attribute(dataset.get(), number.name + ".unit", number.unit));
  }
  return {};
}

Result<void> write_job(hid_t file, const ProgramHeader& header) {
  GRAVURE_TRY(const Handle job, create_group(file, "job"));
  GRAVURE_CHECK(write_text_attribute(job.get(), "fires", header.fires == Fires::white ? "white" : "black"));
  GRAVURE_CHECK(
      write_text_attribute(job.get(), "lines_along", header.lines_along == LinesAlong::rows ? "rows" : "columns"));
  GRAVURE_CHECK(write_text(job.get(), "text", header.job_text));
  GRAVURE_CHECK(write_text(job.get(), "path", header.job_path));
  return {};
}

Result<void> write_layers(hid_t group, const std::vector<StoredLayer>& layers) {
  std::vector<std::uint8_t> starts_reverse;
  std::vector<std::int64_t> fired;
  std::vector<std::int64_t> source;
  std::vector<std::int64_t> level;
  for (const StoredLayer& layer : layers) {
    starts_reverse.push_back(layer.starts_reverse ? 1 : 0);
    fired.push_back(layer.fired_pixels);
    source.push_back(layer.source);
    level.push_back(layer.level);
  }
  const std::array<hsize_t, 1> shape = {layers.size()};
  GRAVURE_CHECK(write_table<std::uint8_t>(group, "starts_reverse", starts_reverse, shape, "1 yes, 0 no"));
  GRAVURE_CHECK(write_table<std::int64_t>(group, "fired_pixels", fired, shape, "pixels"));
  GRAVURE_CHECK(write_table<std::int64_t>(group, "source", source, shape, "row of /sources"));
  return write_table<std::int64_t>(group, "level", level, shape, "slice of a depth map, else 0");
}

/// Only where layers share bits: a program without such layers is the same byte for byte as ever.
Result<void> write_shared_bits(hid_t group, const std::vector<std::uint32_t>& bits_of_layer) {
  if (bits_of_layer.empty()) {
    return {};
  }
  const std::array<hsize_t, 1> shape = {bits_of_layer.size()};
  return write_table<std::uint32_t>(group, kBitsOfLayer, bits_of_layer, shape, "row of layers/bits");
}

Result<void> write_revolutions(hid_t file, const ProgramHeader& header) {
  GRAVURE_TRY(const Handle revolutions, create_group(file, "revolutions"));
  const std::array<hsize_t, 1> shape = {header.layer_of_revolution.size()};
  GRAVURE_CHECK(
      write_table<std::uint32_t>(revolutions.get(), "layer", header.layer_of_revolution, shape, "layer number"));
  if (!header.shard) {
    return {};
  }
  GRAVURE_CHECK(write_attribute<std::int64_t>(revolutions.get(), "first", header.shard->first));
  GRAVURE_CHECK(write_attribute<std::int64_t>(revolutions.get(), "end", header.shard->end));
  return write_attribute<std::int64_t>(revolutions.get(), "image_layers", header.shard->image_layers);
}

Result<std::optional<Shard>> read_shard(hid_t file, bool shard) {
  const Handle revolutions(H5Gopen2(file, "revolutions", H5P_DEFAULT), H5Gclose);
  if (!revolutions.valid() || (H5Aexists(revolutions.get(), "first") > 0) != shard) {
    return Error{ErrorCode::bad_file, shard ? "revolutions: a shard must say which ones it holds"
                                            : "revolutions: missing, or some only although the seal says all"};
  }
  if (!shard) {
    return std::optional<Shard>();
  }
  Shard range;
  GRAVURE_TRY(range.first, read_attribute<std::int64_t>(revolutions.get(), "first"));
  GRAVURE_TRY(range.end, read_attribute<std::int64_t>(revolutions.get(), "end"));
  GRAVURE_TRY(range.image_layers, read_attribute<std::int64_t>(revolutions.get(), "image_layers"));
  return std::optional<Shard>(range);
}

Result<void> check_root(hid_t file, std::uint32_t format_version) {
  GRAVURE_TRY(const std::string format, read_text_attribute(file, "format"));
  if (format != kFormat) {
    return Error{ErrorCode::bad_file, "attribute format is \"" + format + "\": must be \"" + kFormat + "\""};
  }
  GRAVURE_TRY(const auto version, read_attribute<std::uint32_t>(file, "format_version"));
  if (version != format_version) {
    return Error{ErrorCode::version_mismatch, "attribute format_version is " + std::to_string(version) +
                                                  ", the seal says " + std::to_string(format_version) +
                                                  ": compile the job again"};
  }
  return {};
}

Result<Plan> read_plan(hid_t file) {
  GRAVURE_TRY(const std::string json, read_text(file, "plan"));
  GRAVURE_TRY(Plan plan, plan_from_json(json));
  const Handle dataset(H5Dopen2(file, "plan", H5P_DEFAULT), H5Dclose);
  for (const PlanNumber& number : plan_numbers(plan)) {
    GRAVURE_CHECK(std::visit(
        [&](auto expected) -> Result<void> {
          GRAVURE_TRY(const auto found, read_attribute<decltype(expected)>(dataset.get(), number.name));
          if (found != expected) {
            return Error{ErrorCode::bad_file, "attribute " + number.name + " of /plan is " + std::to_string(found) +
                                                  ", its JSON says " + std::to_string(expected)};
          }
          return {};
        },
        number.value));
  }
  return plan;
}

Result<void> read_job(hid_t file, ProgramHeader& header) {
  const Handle job(H5Gopen2(file, "job", H5P_DEFAULT), H5Gclose);
  if (!job.valid()) {
    return Error{ErrorCode::bad_file, "job: missing"};
  }
  GRAVURE_TRY(const std::string fires, read_text_attribute(job.get(), "fires"));
  GRAVURE_TRY(const std::string along, read_text_attribute(job.get(), "lines_along"));
  if ((fires != "white" && fires != "black") || (along != "rows" && along != "columns")) {
    return Error{ErrorCode::bad_file, "job: fires = \"" + fires + "\", lines_along = \"" + along +
                                          "\": must be white or black, rows or columns"};
  }
  header.fires = fires == "white" ? Fires::white : Fires::black;
  header.lines_along = along == "rows" ? LinesAlong::rows : LinesAlong::columns;
  GRAVURE_TRY(header.job_text, read_text(job.get(), "text"));
  GRAVURE_TRY(header.job_path, read_text(job.get(), "path"));
  return {};
}

Result<std::vector<std::uint32_t>> read_shared_bits(hid_t file) {
  const std::string path = std::string("layers/") + kBitsOfLayer;
  if (H5Lexists(file, path.c_str(), H5P_DEFAULT) <= 0) {
    return std::vector<std::uint32_t>();
  }
  GRAVURE_TRY(const std::uint64_t layers, count_rows(file, path.c_str()));
  const std::array<hsize_t, 1> shape = {layers};
  return read_table<std::uint32_t>(file, path.c_str(), shape);
}

Result<std::vector<StoredLayer>> read_layers(hid_t file, std::size_t count) {
  const Handle group(H5Gopen2(file, "layers", H5P_DEFAULT), H5Gclose);
  if (!group.valid()) {
    return Error{ErrorCode::bad_file, "layers: missing"};
  }
  const std::array<hsize_t, 1> shape = {count};
  GRAVURE_TRY(const auto starts_reverse, read_table<std::uint8_t>(group.get(), "starts_reverse", shape));
  GRAVURE_TRY(const auto fired, read_table<std::int64_t>(group.get(), "fired_pixels", shape));
  GRAVURE_TRY(const auto source, read_table<std::int64_t>(group.get(), "source", shape));
  GRAVURE_TRY(const auto level, read_table<std::int64_t>(group.get(), "level", shape));
  std::vector<StoredLayer> layers;
  for (std::size_t i = 0; i < starts_reverse.size(); ++i) {
    if (starts_reverse[i] > 1) {
      return Error{ErrorCode::bad_file, "layers/starts_reverse of layer " + std::to_string(i) + " = " +
                                            std::to_string(starts_reverse[i]) + ": must be 0 or 1"};
    }
    layers.push_back({starts_reverse[i] == 1, fired[i], source[i], level[i]});
  }
  return layers;
}

}  // namespace

Result<void> write_root(hid_t file, std::uint32_t format_version) {
  const Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  GRAVURE_CHECK(write_text_attribute(root.get(), "format", kFormat));
  GRAVURE_CHECK(write_attribute<std::uint32_t>(root.get(), "format_version", format_version));
  GRAVURE_CHECK(write_text_attribute(root.get(), "gravure_version", GRAVURE_VERSION));
  return write_text_attribute(root.get(), "units", kUnits);
}

Result<void> write_header(hid_t file, hid_t layers_group, const ProgramHeader& header) {
  GRAVURE_CHECK(write_plan(file, header.plan));
  GRAVURE_CHECK(write_job(file, header));
  GRAVURE_CHECK(write_sources(file, kSources, header.sources));
  if (!header.files.empty()) {  // programs of jobs that name none are what they were before there was this table
    GRAVURE_CHECK(write_sources(file, kFiles, header.files));
  }
  GRAVURE_CHECK(write_layers(layers_group, header.layers));
  GRAVURE_CHECK(write_shared_bits(layers_group, header.bits_of_layer));
  GRAVURE_CHECK(write_revolutions(file, header));
  return write_set_points(file, header.set_points);
}

Result<ProgramHeader> read_header(hid_t file, const Layout& layout, bool shard, std::uint32_t format_version) {
  ProgramHeader header;
  header.format_version = format_version;
  const Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  GRAVURE_CHECK(check_root(root.get(), format_version));
  GRAVURE_TRY(header.plan, read_plan(file));
  if (format_version_of(header.plan) != format_version) {
    return Error{ErrorCode::bad_file, "format version " + std::to_string(format_version) + ": that of its plan is " +
                                          std::to_string(format_version_of(header.plan))};
  }
  GRAVURE_CHECK(read_job(file, header));
  GRAVURE_TRY(header.sources, read_sources(file, kSources));
  if (H5Lexists(file, kFiles, H5P_DEFAULT) > 0) {
    GRAVURE_TRY(header.files, read_sources(file, kFiles));
  }
  GRAVURE_TRY(header.bits_of_layer, read_shared_bits(file));
  GRAVURE_TRY(header.layers, read_layers(file, header.bits_of_layer.empty() ? static_cast<std::size_t>(layout.layers)
                                                                            : header.bits_of_layer.size()));
  if (header.plan.job.revolutions < 1) {
    return Error{ErrorCode::bad_file,
                 "plan: revolutions = " + std::to_string(header.plan.job.revolutions) + ": must be at least 1"};
  }
  GRAVURE_TRY(header.shard, read_shard(file, shard));
  const Shard all = header.shard.value_or(Shard{0, header.plan.job.revolutions, 1});
  if (all.first < 0 || all.end <= all.first || all.end > header.plan.job.revolutions) {
    return Error{ErrorCode::bad_file, "revolutions: a shard of " + std::to_string(all.first) + " to " +
                                          std::to_string(all.end) + " of " +
                                          std::to_string(header.plan.job.revolutions)};
  }
  const std::array<hsize_t, 1> shape = {static_cast<hsize_t>(all.end - all.first)};
  GRAVURE_TRY(header.layer_of_revolution, read_table<std::uint32_t>(file, "revolutions/layer", shape));
  GRAVURE_TRY(header.set_points, read_set_points(file, header.plan));
  return header;
}

}  // namespace gravure::grv
