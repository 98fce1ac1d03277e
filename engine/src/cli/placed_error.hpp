#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "gravure/core/error.hpp"
#include "gravure/core/job.hpp"

namespace gravure::cli {

/// Where the job says what the error is about: at the key that the message begins with, else at `key`. Without a job
/// file it says so already.
Error placed_error(const Job& job, std::string_view key, Error error);

template <class T>
Result<T> placed(const Job& job, std::string_view key, Result<T> result) {
  return result ? std::move(result) : Result<T>(placed_error(job, key, result.error()));
}

}  // namespace gravure::cli
