// The bake: every cell of a grid, on one machine or shared out over MPI ranks, resumed where it was killed.
#pragma once

#include <filesystem>
#include <functional>

#include "workbench/bake/cell_baker.hpp"

namespace sightline::bake {

/// Which part of the cells this process bakes, and how it meets the others. The default is alone.
class Ranks {
public:
  Ranks() = default;
  /// Joins the other ranks where the process was started by mpirun; alone otherwise. Ends MPI when it goes.
  static Ranks join();
  Ranks(Ranks&& other) noexcept;
  Ranks& operator=(Ranks&&) = delete;
  ~Ranks();

  [[nodiscard]] int rank() const noexcept { return rank_; }
  [[nodiscard]] int count() const noexcept { return count_; }
  /// Whether mpirun started the process, be it as the only rank.
  [[nodiscard]] bool joined() const noexcept { return joined_; }
  void wait() const;
  /// Every rank's bytes one after the other, on rank 0; nothing elsewhere.
  [[nodiscard]] std::vector<std::byte> gather(const std::vector<std::byte>& mine) const;

private:
  int rank_ = 0, count_ = 1;
  bool joined_ = false;
};

struct BakeResult {
  bool finished = false;
  std::uint64_t rays = 0;     ///< this rank cast
  std::uint32_t resumed = 0;  ///< cells found done
  CellPvs cells;              ///< on rank 0 of a finished bake
};

/// What this rank has before it, as a few cells that were tried out tell.
struct BakeEstimate {
  std::size_t cells = 0;  ///< that wait
  double open = 0;        ///< of them, about
  double seconds = 0;     ///< at least: what finds something new is followed by more rays
};

/// Bakes and writes `file`, the same bytes however often it was killed, over however many ranks and threads
/// (`threads` of this rank; 0: as many as the process has cores). Beside it lie journals, `file`.part.RANK,
/// until it is finished. `progress` is told how many of this rank's cells are done, one call at a time, and
/// may return false to begin no more. `estimated` is told once, before the first cell. Throws Error.
BakeResult bake(const Scene& scene, const CellOptions& options, const std::filesystem::path& file,
                const Ranks& ranks, int threads = 0,
                const std::function<bool(std::size_t done, std::size_t all)>& progress = {},
                const std::function<void(const BakeEstimate&)>& estimated = {});

}  // namespace sightline::bake
