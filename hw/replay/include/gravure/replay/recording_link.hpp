#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "gravure/core/device_link.hpp"
#include "gravure/replay/session_text.hpp"

namespace gravure::replay {

/// Writes down everything that is said over a link, line by line as it happens (docs/formats/session.md).
class RecordingLink final : public DeviceLink {
 public:
  /// io where the file is there already or cannot be written.
  static Result<std::unique_ptr<RecordingLink>> create(std::unique_ptr<DeviceLink> link, const std::string& path);

  const DeviceIdentity& identity() const noexcept override { return link_->identity(); }
  Result<std::uint32_t> read_register(std::uint8_t address) override;
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override;
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override;
  Result<bool> drain(Milliseconds patience) override;
  Result<void> abandon() override;
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override;

  /// io where a line could not be written. The link is not disturbed by that; this tells.
  Result<void> written() const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };
  using File = std::unique_ptr<std::FILE, Close>;
  RecordingLink(std::unique_ptr<DeviceLink> link, std::string path, File file);
  void write(const std::string& text);

  std::unique_ptr<DeviceLink> link_;
  std::string path_;
  File file_;
  int failed_ = 0;  ///< errno of the first line that could not be written
};

}  // namespace gravure::replay
