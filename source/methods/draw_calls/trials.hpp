// Finds out which of several ways is quickest while they are in use: by turns at first, then by rare trials.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace sightline::methods {

/// At first every way takes its turn: two frames, of which the second counts, for the first finds the caches
/// cold. Rounds run to and fro, so that a camera on its way favours none; nothing counts as more than twice a
/// round's median, so that a hitch decides little. After some rounds the slower half is dropped, then all but
/// four, then one is settled on, the lowest number of those that are alike within 1 %: 1,200 frames with a
/// dozen ways. From then on one frame in 64 tries one of the three that came next, and a rival that turns out
/// 5 % quicker takes the winner's place. Same times told, same turns; allocates only when made.
class Trials {
public:
  /// At least one way; `first` has the first turn, and keeps it until a time is told.
  Trials(std::uint32_t ways, std::uint32_t first);

  /// Whose turn it is.
  [[nodiscard]] std::uint32_t current() const noexcept { return current_; }
  /// What the last frame of the current way took, in any unit; the turn passes on. What is not a positive
  /// time is ignored.
  void took(double time) noexcept;
  [[nodiscard]] bool settled() const noexcept { return settled_; }
  /// The one settled on; until then the best so far.
  [[nodiscard]] std::uint32_t winner() const noexcept { return ways_.front().id; }

private:
  static constexpr std::array<std::uint32_t, 3> kRounds{16, 32, 60};
  static constexpr std::uint32_t kFinalists = 4, kBetweenTrials = 128, kTrials = 5;
  static constexpr double kWorthAChange = 0.95, kAlike = 1.01;

  struct Way {
    std::uint32_t id = 0, samples = 0;
    double sum = 0;                        ///< of the phase's times
    std::array<double, kTrials> ratios{};  ///< to the winner's, once settled
  };

  [[nodiscard]] Way& turn(std::uint32_t position) noexcept;
  void end_round() noexcept;
  void end_phase() noexcept;
  void watch(double time) noexcept;

  std::vector<Way> ways_;  ///< those still in the running first
  std::vector<double> round_, sorted_;
  std::uint32_t running_, position_ = 0, rounds_ = 0, phase_ = 0;
  std::uint32_t current_;
  bool settled_ = false;
  bool warm_ = false;  ///< the turn's first frame is over

  // once settled
  bool trying_ = false;
  double own_ = 0;
  std::uint32_t since_ = 0, rival_ = 0;
};

}  // namespace sightline::methods
