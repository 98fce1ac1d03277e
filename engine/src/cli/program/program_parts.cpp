#include "program/program_parts.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "gravure/formats/job_file.hpp"
#include "gravure/formats/plan_json.hpp"
#include "gravure/pipeline/merge.hpp"
#include "progress_bar.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

bool same_sources(const std::vector<SourceImage>& a, const std::vector<SourceImage>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const SourceImage& one, const SourceImage& other) {
    return one.path == other.path && one.page == other.page && one.width == other.width && one.height == other.height &&
           one.sha256 == other.sha256;
  });
}

/// What two shards of one job have in common: the first thing that they have not, or nothing.
std::string difference(const ProgramHeader& a, const ProgramHeader& b) {
  const auto same_points = [](const LineSetPoints& one, const LineSetPoints& other) {
    return one.u_counts == other.u_counts && one.v_counts == other.v_counts;
  };
  if (a.job_text != b.job_text) {
    return "the text of their job files";
  }
  if (!same_sources(a.files, b.files)) {
    return "the files that their job names (field grid, machine file)";
  }
  if (plan_to_json(a.plan) != plan_to_json(b.plan)) {
    return "their plans (another version of a file that the job names, or of gravure)";
  }
  if (a.fires != b.fires || a.lines_along != b.lines_along) {
    return "what fires, or where lines run";
  }
  if (!std::equal(a.set_points.begin(), a.set_points.end(), b.set_points.begin(), b.set_points.end(), same_points)) {
    return "the set-points of their scanner";
  }
  if (a.shard && b.shard && a.shard->image_layers != b.shard->image_layers) {
    return fmt::format("the number of layers in their image stacks, {} and {}", a.shard->image_layers,
                       b.shard->image_layers);
  }
  return {};
}

bool same_layers(const std::vector<StoredLayer>& a, const std::vector<StoredLayer>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const StoredLayer& one, const StoredLayer& other) {
    return one.source == other.source && one.level == other.level;
  });
}

std::int64_t chunks_of(const LineSource& program) {
  const std::int64_t lines = program.header().plan.rotary.lines_per_revolution;
  return (lines + program.lines_per_chunk() - 1) / program.lines_per_chunk();
}

/// Does every checksum hold?
Result<bool> is_sound(LineSource& program, const CancelToken& cancel) {
  const ProgramHeader& header = program.header();
  const std::int64_t lines = header.plan.rotary.lines_per_revolution;
  std::vector<std::byte> bits(static_cast<std::size_t>(program.lines_per_chunk() * header.line_bytes()));
  for (std::int64_t layer = 0; layer < static_cast<std::int64_t>(header.layers.size()); ++layer) {
    for (std::int64_t chunk = 0; chunk < chunks_of(program); ++chunk) {
      if (cancel.cancelled()) {
        return Error{ErrorCode::cancelled, "stopped while the output that is there was being checked"};
      }
      const std::int64_t count = std::min(program.lines_per_chunk(), lines - chunk * program.lines_per_chunk());
      const Result<StoredChunk> stored = program.fetch({layer, chunk});
      if (!stored || !program.decode(stored.value(),
                                     std::span(bits).first(static_cast<std::size_t>(count * header.line_bytes())))) {
        return false;
      }
    }
  }
  return true;
}

/// All shards stay open while they are copied; the usual limit is 1024 files, the one that may be asked for is higher.
void allow_open_files(std::size_t count) {
  struct rlimit limit = {};
  constexpr rlim_t kOthers = 64;
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < count + kOthers) {
    limit.rlim_cur = std::min<rlim_t>(count + kOthers, limit.rlim_max);
    setrlimit(RLIMIT_NOFILE, &limit);  // where it is refused, opening says so
  }
}

Result<std::vector<GrvPart>> open_parts(const std::vector<std::string>& paths) {
  allow_open_files(paths.size());
  std::vector<GrvPart> parts;
  for (const std::string& path : paths) {
    GRAVURE_TRY(GrvPart part, open_grv_part(path));
    if (!part.lines->header().shard) {
      return Error{ErrorCode::bad_file, path + ": is a whole program, no shard: there is nothing to merge"};
    }
    if (!parts.empty()) {
      const std::string differs = difference(parts.front().lines->header(), part.lines->header());
      if (!differs.empty()) {
        return Error{ErrorCode::bad_argument, fmt::format("{} and {} are shards of different jobs: they differ in {}",
                                                          paths.front(), path, differs)};
      }
      if (part.compression != parts.front().compression ||
          part.lines->lines_per_chunk() != parts.front().lines->lines_per_chunk()) {
        return Error{ErrorCode::bad_argument,
                     fmt::format("{} and {} are stored differently: compile all shards with the same --compression",
                                 paths.front(), path)};
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

Result<void> write_program(const MergedProgram& merged, std::span<const MergePart> parts, const std::string& output,
                           const GrvOptions& grv) {
  const ProgramHeader& header = merged.header;
  GRAVURE_TRY(const std::unique_ptr<LineSink> sink,
              create_grv(output, static_cast<std::int64_t>(merged.bits.size()), header.plan.rotary.lines_per_revolution,
                         header.line_bytes(), grv));
  if (sink->lines_per_chunk() != parts.front().lines->lines_per_chunk()) {
    return Error{ErrorCode::version_mismatch,
                 fmt::format("{} has {} lines a chunk, this gravure {} would make {}: merge with the version that "
                             "compiled the shards",
                             parts.front().name, parts.front().lines->lines_per_chunk(), GRAVURE_VERSION,
                             sink->lines_per_chunk())};
  }
  ProgressBar bar("merge", "chunks");
  return write_merged(merged, parts, *sink, &cancel_token(), &bar);
}

/// From the folder of one program to that of another.
std::string job_path_from(const std::string& output, const ProgramHeader& header, const std::string& shard) {
  std::error_code failed;
  const fs::path job = fs::path(shard).parent_path() / header.job_path;
  const fs::path folder = fs::path(output).parent_path();
  const fs::path near = fs::proximate(job, folder.empty() ? fs::path(".") : folder, failed);
  return failed ? header.job_path : near.generic_string();
}

/// A whole program that stores every layer, made of itself: its header has `bits_of_layer` where layers are equal.
Result<MergedProgram> share_bits_of(std::span<const MergePart> whole) {
  const ProgramHeader& header = whole.front().lines->header();
  GRAVURE_TRY(MergedProgram merged, join_parts(whole, [&header](std::int64_t revolution) {
                const std::uint32_t layer = header.layer_of_revolution[static_cast<std::size_t>(revolution)];
                return LayerNumber{layer, header.layers[layer].source};
              }));
  GRAVURE_CHECK(share_equal_bits(merged, whole, &cancel_token()));
  return merged;
}

/// Older versions put a program in its place before they looked for equal layers, and could be killed in between.
Result<bool> stores_equal_layers_once(LineSource& program, const std::string& path) {
  const ProgramHeader& header = program.header();
  if (header.shard || !header.bits_of_layer.empty() || !may_share_bits(header)) {
    return true;
  }
  const std::vector<MergePart> whole = {{&program, path}};
  GRAVURE_TRY(const MergedProgram merged, share_bits_of(whole));
  return merged.header.bits_of_layer.empty();
}

}  // namespace

Result<std::optional<ProgramHeader>> write_shared(const std::string& path, const std::string& output,
                                                  const GrvOptions& grv) {
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(path));
  const std::vector<MergePart> whole = {{program.get(), path}};
  GRAVURE_TRY(MergedProgram merged, share_bits_of(whole));
  if (merged.header.bits_of_layer.empty()) {
    return std::optional<ProgramHeader>();
  }
  GRAVURE_CHECK(write_program(merged, whole, output, grv));
  return std::optional<ProgramHeader>(std::move(merged.header));
}

Result<std::optional<ProgramHeader>> finished_output(const ProgramHeader& wanted, const CompileRequest& request,
                                                     const CancelToken& cancel) {
  const std::optional<ProgramHeader> none;
  Result<GrvPart> found = open_grv_part(request.output);
  if (!found) {
    return none;  // not there, cut off or damaged: whatever it is, it is made anew
  }
  LineSource& program = *found.value().lines;
  const ProgramHeader& header = program.header();
  const bool same =
      header.shard == wanted.shard && difference(header, wanted).empty() && header.job_path == wanted.job_path &&
      same_sources(header.sources, wanted.sources) && same_layers(header.layers, wanted.layers) &&
      header.layer_of_revolution == wanted.layer_of_revolution && found.value().compression == request.grv.compression;
  if (!same) {
    return none;
  }
  GRAVURE_TRY(const bool sound, is_sound(program, cancel));
  if (!sound) {
    return none;
  }
  GRAVURE_TRY(const bool once, stores_equal_layers_once(program, request.output));
  return once ? std::optional<ProgramHeader>(header) : none;
}

Result<ProgramHeader> merge_shards(const std::vector<std::string>& shards, const std::string& output) {
  cancel_token();
  GRAVURE_TRY(const std::vector<GrvPart> opened, open_parts(shards));
  std::vector<MergePart> parts;
  for (std::size_t i = 0; i < shards.size(); ++i) {
    parts.push_back({opened[i].lines.get(), shards[i]});
  }
  const ProgramHeader& first = opened.front().lines->header();
  GRAVURE_TRY(const Job job, parse_job(first.job_text, first.job_path));
  StoredLayers stored(first.plan, job.image.order, first.shard->image_layers);
  const bool one_image = job.image.depth_map || first.plan.carriage;  // of which parts need not say more
  GRAVURE_TRY(MergedProgram merged, join_parts(parts, [&](std::int64_t revolution) {
                return LayerNumber{stored.number(revolution), one_image ? 0 : stored.image_layer(revolution)};
              }));
  merged.header.job_path = job_path_from(output, first, shards.front());
  GRAVURE_CHECK(share_equal_bits(merged, parts, &cancel_token()));
  GrvOptions grv;
  grv.compression = opened.front().compression;
  GRAVURE_CHECK(write_program(merged, parts, output, grv));
  return merged.header;
}

}  // namespace gravure::cli
