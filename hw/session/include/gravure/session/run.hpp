#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/device_link.hpp"
#include "gravure/core/program.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/session/handshake.hpp"
#include "gravure/session/journal.hpp"
#include "gravure/session/preflight.hpp"
#include "gravure/session/resume.hpp"

namespace gravure::session {

struct RunOptions {
  ResumeOptions resume;
  std::int64_t reserve_bytes = 0;  ///< that the board holds before lines run; 0: half of its buffer
  std::int64_t memory_bytes = std::int64_t{256} << 20;  ///< of the program read ahead
  bool through = false;                     ///< go on behind a band or pass without waiting for the operator
  std::chrono::milliseconds stall{10'000};  ///< a board that does nothing for so long is out of order
};

/// How far a job is, lines counted over the whole job.
struct RunCounts {
  std::int64_t sent = 0;      ///< handed to the link
  std::int64_t accepted = 0;  ///< taken by the board, in sequence and whole
  std::int64_t executed = 0;  ///< passed from the first slot to the last, without those that were skipped
  std::int64_t total = 0;
};

/// Told what happens, on the thread that runs the program.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void on_counts(const RunCounts& counts) = 0;
  /// A line for people.
  virtual void on_note(const std::string& text) = 0;
};

enum class RunEnd : std::uint8_t {
  finished,  ///< every line of the job is executed, or was skipped
  part_end,  ///< a band or pass is; `to_do` says what the next one needs
  stopped,   ///< asked to
  failed,    ///< by a fault, the link or the journal
};

struct RunReport {
  RunEnd end = RunEnd::finished;
  std::optional<Error> error;  ///< stopped and failed: what went wrong and what is known to have been fired
  BoardInfo board;
  LinkDemand demand;
  std::int64_t reserve_bytes = 0;
  Beginning begun;
  ResumeOffset offset;
  RunCounts counts;
  Place executed;
  bool exact = true;  ///< false: lines from `executed` to `sent_limit` may have run, too
  std::int64_t sent_limit = 0;
  std::vector<Uncertain> skipped;  ///< in this exposure, not known to be fired
  DeviceFault fault = DeviceFault::none;
  std::string to_do;
};

/// Runs a program on a board from its first line, or from where the journal says. Errors are of what goes wrong before
/// the board is asked to do anything; later ones are in the report. The gate is closed when it returns, by the board or
/// by the host.
Result<RunReport> run_program(LineSource& program, DeviceLink& link, Journal& journal, const RunOptions& options,
                              RunObserver& observer, const CancelToken& cancel);

}  // namespace gravure::session
