#include "core/experiment/frames.h"

#include <bit>
#include <cstring>
#include <stdexcept>

#include "core/mesh/file.h"

namespace drape {

static_assert(std::endian::native == std::endian::little, "frames are written as they lie in memory");

void Frames::begin_level() {
  kept_.clear();
  spacing_ = 1;
  seen_ = 0;
}

void Frames::iteration(const Work& work, const Positions& x) {
  const bool wanted = most_ > 1 && seen_ % spacing_ == 0;
  ++seen_;
  if (!wanted) return;
  if (static_cast<int>(kept_.size()) == most_ - 1) {  // one place is the last state's
    for (std::size_t k = 1; 2 * k < kept_.size(); ++k) kept_[k] = std::move(kept_[2 * k]);
    kept_.resize((kept_.size() + 1) / 2);
    spacing_ *= 2;
    if ((seen_ - 1) % spacing_ != 0 || static_cast<int>(kept_.size()) == most_ - 1) return;
  }
  kept_.push_back({work, x});
}

std::vector<Frame> Frames::end_level(const Work& work, const Positions& last) {
  if (!kept_.empty() && kept_.back().work.iterations == work.iterations) kept_.pop_back();
  kept_.push_back({work, last});
  return std::move(kept_);
}

void write_frames(const std::filesystem::path& file, const std::vector<Frame>& frames) {
  std::string bytes;
  for (const Frame& frame : frames) {
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> x = frame.x.cast<float>();
    bytes.append(reinterpret_cast<const char*>(x.data()), sizeof(float) * x.size());
  }
  write_file(file, bytes);
}

std::vector<Positions> read_frames(const std::filesystem::path& file, int vertices) {
  const std::string bytes = read_file(file);
  const std::size_t size = sizeof(float) * 3 * vertices;
  if (size == 0 || bytes.size() % size != 0)
    throw std::runtime_error(file.string() + ": not made of frames of " + std::to_string(vertices) +
                             " vertices; is it cut short?");
  std::vector<Positions> frames;
  for (std::size_t at = 0; at < bytes.size(); at += size) {
    Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> x(vertices, 3);
    std::memcpy(x.data(), bytes.data() + at, size);
    frames.push_back(x.cast<double>());
  }
  return frames;
}

}  // namespace drape
