#include "workbench/bake/bake.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iterator>
#include <mutex>
#include <optional>
#include <string>

#include <sightline/workbench/error.hpp>

#include "library/pvs/checksum.hpp"
#include "library/pvs/set_coding.hpp"
#include "workbench/bake/journal.hpp"
#include "workbench/bake/pvs_file.hpp"
#include "workbench/io/byte_reader.hpp"

#ifdef SIGHTLINE_MPI
#include <mpi.h>
#endif

namespace sightline::bake {

namespace {

std::uint64_t key_of(const CellPvs& cells, const CellOptions& options) {
  std::uint64_t key = pvs::checksum(std::as_bytes(std::span(&cells.scene, 1)));
  key = pvs::checksum(std::as_bytes(std::span(cells.counts)), key);
  key = pvs::checksum(std::as_bytes(std::span(&options.target, 1)), key);
  key = pvs::checksum(std::as_bytes(std::span(&options.seed, 1)), key);
  const std::uint32_t sampling[] = {options.rays, options.most_viewpoints};
  return pvs::checksum(std::as_bytes(std::span(sampling)), key);
}

// All journals beside the file, whoever wrote them: a bake may go on with another number of ranks.
std::vector<std::filesystem::path> journals_of(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> found;
  const std::string prefix = file.filename().string() + ".part.";
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    if (entry.path().filename().string().starts_with(prefix)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::byte> flatten(const PackedCells& done) {
  std::vector<std::byte> bytes;
  for (const auto& [cell, set] : done) {
    const std::uint32_t head[] = {cell, static_cast<std::uint32_t>(set.size())};
    const auto raw = std::as_bytes(std::span(head));
    bytes.insert(bytes.end(), raw.begin(), raw.end());
    bytes.insert(bytes.end(), set.begin(), set.end());
  }
  return bytes;
}

void take_in(const std::vector<std::byte>& bytes, PackedCells& done) {
  for (std::size_t at = 0; io::fits(at, 8, bytes.size());) {
    const auto cell = io::read_at<std::uint32_t>(bytes, at),
               length = io::read_at<std::uint32_t>(bytes, at + 4);
    if (!io::fits(at + 8, length, bytes.size())) throw Error("bake: a rank sent broken sets");
    const auto* set = bytes.data() + at + 8;
    done[cell].assign(set, set + length);
    at += 8 + std::size_t{length};
  }
}

BakeEstimate estimate(CellBaker baker, const CellPvs& cells, std::span<const std::uint32_t> waiting,
                      int threads) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t kTried = 64;
  const auto start = Clock::now();
  const std::size_t tried = std::min(kTried, waiting.size());
  std::size_t open = 0;
  for (std::size_t i = 0; i < tried; ++i) open += baker.try_out(cells, waiting[i * waiting.size() / tried]);
  BakeEstimate out{waiting.size()};
  if (open == 0) return out;
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  out.open = static_cast<double>(waiting.size() * open) / static_cast<double>(tried);
  out.seconds = out.open * baker.least_rays() * seconds / static_cast<double>(baker.rays_cast()) /
                (threads > 0 ? threads : tbb::this_task_arena::max_concurrency());
  return out;
}

// Reads what was baked before. Returns how long this rank's own journal is, as far as it is whole.
std::uint64_t read_journals(const std::filesystem::path& file, const std::filesystem::path& own,
                            std::uint64_t key, std::size_t cells, PackedCells& done) {
  std::uint64_t whole = 0;
  for (const auto& journal : journals_of(file)) {
    const std::uint64_t length = read_journal(journal, key, cells, done);
    if (journal.filename() == own.filename()) whole = length;
  }
  return whole;
}

void remove_journals(const std::filesystem::path& file, std::uint64_t key) {
  for (const auto& journal : journals_of(file)) {
    std::error_code ignored;
    if (is_journal(journal, key)) std::filesystem::remove(journal, ignored);
  }
}

// The rank's own cells: as many ranks as there are, one cell in so many.
std::vector<std::uint32_t> share_of(const Ranks& ranks, std::size_t cells) {
  std::vector<std::uint32_t> share;
  for (auto cell = static_cast<std::size_t>(ranks.rank()); cell < cells;
       cell += static_cast<std::size_t>(ranks.count()))
    share.push_back(static_cast<std::uint32_t>(cell));
  return share;
}

// Calls work(i) for i below count on so many threads; 0: one a core.
template <class Work>
void run_threads(std::size_t count, int threads, const Work& work) {
  // More threads than cores are allowed if asked for.
  std::optional<tbb::global_control> allowed;
  if (threads > 0)
    allowed.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena(threads > 0 ? threads : tbb::task_arena::automatic).execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const auto& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
        },
        tbb::simple_partitioner());
  });
}

// Puts the sets of all cells where they belong.
void unpack(const PackedCells& done, CellPvs& cells) {
  cells.first.assign(1, 0);
  for (const auto& [cell, set] : done) {
    cells.open[cell] = !set.empty();
    if (!set.empty()) {
      if (const pvs::Complaint wrong = pvs::unpack_set(set, cells.objects, cells.visible))
        throw Error(sentence_about("bake: cell " + std::to_string(cell), wrong));
    }
    cells.first.push_back(cells.visible.size());
  }
}

}  // namespace

BakeResult bake(const Scene& scene, const CellOptions& options, const std::filesystem::path& file,
                const Ranks& ranks, int threads,
                const std::function<bool(std::size_t done, std::size_t all)>& progress,
                const std::function<void(const BakeEstimate&)>& estimated) {
  BakeResult result;
  CellPvs cells = make_cells(scene, options);
  const std::uint64_t key = key_of(cells, options);
  PackedCells done;
  const std::filesystem::path own = file.string() + ".part." + std::to_string(ranks.rank());
  const std::uint64_t whole = read_journals(file, own, key, cells.size(), done);
  ranks.wait();  // nobody appends while another reads
  Journal journal(own, key, whole);

  const std::vector<std::uint32_t> share = share_of(ranks, cells.size());
  std::vector<std::uint32_t> waiting;
  std::copy_if(share.begin(), share.end(), std::back_inserter(waiting),
               [&](std::uint32_t cell) { return !done.contains(cell); });
  result.resumed = static_cast<std::uint32_t>(share.size() - waiting.size());
  const partition::TriangleRays rays(scene);
  if (estimated) estimated(estimate(CellBaker(scene, rays, options), cells, waiting, threads));

  tbb::enumerable_thread_specific<CellBaker> bakers([&] { return CellBaker(scene, rays, options); });
  tbb::enumerable_thread_specific<std::vector<ObjectId>> sets;
  std::mutex one_at_a_time;
  std::size_t finished = result.resumed;
  bool stopped = progress && finished > 0 && !progress(finished, share.size());
  run_threads(waiting.size(), threads, [&](std::size_t i) {
    {
      const std::scoped_lock lock(one_at_a_time);
      if (stopped) return;
    }
    std::vector<ObjectId>& visible = sets.local();
    std::vector<std::byte> set;
    if (bakers.local().bake(cells, waiting[i], visible)) set = pvs::pack_set(visible);
    const std::scoped_lock lock(one_at_a_time);
    journal.add(waiting[i], set);
    done[waiting[i]] = std::move(set);
    ++finished;
    if (progress && !progress(finished, share.size())) stopped = true;
  });
  for (const CellBaker& baker : bakers) result.rays += baker.rays_cast();

  const std::vector<std::byte> all = ranks.gather(flatten(done));
  if (ranks.rank() != 0) {
    result.finished = !stopped;
    return result;
  }
  take_in(all, done);
  if (done.size() != cells.size()) return result;
  unpack(done, cells);
  write_pvs_file(cells, file);
  remove_journals(file, key);
  result.finished = true;
  result.cells = std::move(cells);
  return result;
}

Ranks Ranks::join() {
  Ranks ranks;
#ifdef SIGHTLINE_MPI
  // Only under mpirun: alone, MPI would start helpers of its own for nothing.
  if (std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMI_SIZE") || std::getenv("PMIX_RANK")) {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks.count_);
    ranks.joined_ = true;
  }
#endif
  return ranks;
}

Ranks::Ranks(Ranks&& other) noexcept : rank_(other.rank_), count_(other.count_), joined_(other.joined_) {
  other.joined_ = false;
}

Ranks::~Ranks() {
#ifdef SIGHTLINE_MPI
  if (joined_) MPI_Finalize();
#endif
}

void Ranks::wait() const {
#ifdef SIGHTLINE_MPI
  if (joined_) MPI_Barrier(MPI_COMM_WORLD);
#endif
}

std::vector<std::byte> Ranks::gather(const std::vector<std::byte>& mine) const {
  std::vector<std::byte> all = mine;
#ifdef SIGHTLINE_MPI
  if (joined_) {
    if (mine.size() > 0x7fffffff) throw Error("bake: one rank's sets exceed 2 GiB, use more ranks");
    const int size = static_cast<int>(mine.size());
    std::vector<int> sizes(static_cast<std::size_t>(count_)), starts(sizes.size());
    MPI_Gather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
    std::int64_t total = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) starts[i] = static_cast<int>(total), total += sizes[i];
    if (total > 0x7fffffff) throw Error("bake: all sets together exceed 2 GiB, use larger cells");
    all.resize(rank_ == 0 ? static_cast<std::size_t>(total) : 0);
    MPI_Gatherv(mine.data(), size, MPI_BYTE, all.data(), sizes.data(), starts.data(), MPI_BYTE, 0,
                MPI_COMM_WORLD);
  }
#endif
  return all;
}

}  // namespace sightline::bake
