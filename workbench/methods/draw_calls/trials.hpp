// Finds out which of several ways is quickest while they are in use: by turns at first, then by rare trials.
#pragma once

#include <cstdint>
#include <vector>

#include "workbench/scene/random.hpp"

namespace sightline::methods {

/// At first every way takes its turn: two frames, of which the second counts, for the first finds the caches
/// cold. Rounds come in pairs, one in an order drawn anew and one in its reverse, so that a camera on its way
/// favours none; nothing counts as more than twice a round's median, so that a hitch decides little. A way
/// leaves once it is surely slower than the leader, by what the pairs' differences scatter, or once eight and
/// later four are enough; those that are surely alike, or run till the end, are settled by their means, the
/// lowest number first of those alike within half a per cent: some 4,500 frames with a dozen ways. From then
/// on one frame in 64 tries one of the three that held out longest, and a rival that is surely quicker takes
/// the winner's place. Same times told, same turns; allocates only when made.
class Trials {
public:
  /// At least one way; `first` has the first turn, and keeps it until a time is told.
  Trials(std::uint32_t ways, std::uint32_t first);

  /// Whose turn it is.
  [[nodiscard]] std::uint32_t current() const noexcept { return current_; }
  /// What the last frame of the current way took, in any unit; the turn passes on. What is not a positive
  /// time is ignored.
  void report_frame_time(double time) noexcept;
  [[nodiscard]] bool settled() const noexcept { return settled_; }
  /// The one settled on; until then the best so far.
  [[nodiscard]] std::uint32_t winner() const noexcept { return ways_.front().id; }

  static constexpr std::uint32_t kMostPairs = 192;  ///< of rounds; then it settles

private:
  struct Way {
    std::uint32_t id = 0;
    double mean = 0;               ///< of its pairs' times
    double slower = 0, error = 0;  ///< than the leader: mean difference, and its standard error
  };
  /// A rival's logarithmic ratios to the winner, old ones fading.
  struct Record {
    double weight = 0, sum = 0, squares = 0;
  };

  void end_round() noexcept;
  void compare() noexcept;
  void settle() noexcept;
  void watch(double time) noexcept;

  std::vector<Way> ways_;             ///< those still in the running first, then the last to leave
  std::vector<std::uint32_t> order_;  ///< of the round: ids
  std::vector<double> round_, sorted_;
  std::vector<double> pairs_;  ///< times of pair p and way w at [p · ways + w]
  std::uint32_t running_, position_ = 0, rounds_ = 0;
  std::uint32_t current_;
  scene::Random random_{1};
  bool settled_ = false;
  bool warm_ = false;  ///< the turn's first frame is over

  // once settled
  std::vector<Record> records_;  ///< one a rival
  bool trying_ = false;
  double own_ = 0;
  std::uint32_t since_ = 0, rival_ = 0;
};

}  // namespace sightline::methods
