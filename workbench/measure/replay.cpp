#include "workbench/measure/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include <sightline/workbench/error.hpp>

#include "workbench/camera/path_file.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/measure/mover.hpp"

namespace sightline::measure {

namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;  // to write

constexpr std::size_t kMostBytes = 1 << 20;
constexpr std::size_t kMostMoves = 1'000'000;
constexpr std::uint32_t kMostPixels = 4096;                 // a side, as --size has it
constexpr std::array kFaces{"materials", "both", "front"};  // in the order of RasterState

// Whether a value is of the type, which Json would bend other numbers to.
template <class Value>
bool is_one(const Json& value) {
  if constexpr (std::is_unsigned_v<Value>)
    return value.is_number_unsigned() &&
           value.template get<std::uint64_t>() <= std::numeric_limits<Value>::max();
  return true;
}

[[noreturn]] void throw_wrong(const char* name, const std::string& file) {
  throw Error(fmt::format("{}: \"{}\" is missing or of another type than a replay has", file, name));
}

// A member of the type asked for; says which one is missing or another.
template <class Value>
Value member(const Json& document, const char* name, const std::string& file) {
  const auto found = document.find(name);
  try {
    if (found != document.end() && is_one<Value>(*found)) return found->template get<Value>();
  } catch (const Json::exception&) {
  }
  throw_wrong(name, file);
}

// One that has others, where it stands: it may be as deep as a stack is not.
const Json& part(const Json& document, const char* name, Json::value_t type, const std::string& file) {
  const auto found = document.find(name);
  if (found == document.end() || found->type() != type) throw_wrong(name, file);
  return *found;
}

std::size_t raster_state_of(const std::string& name, const std::string& file) {
  for (std::size_t i = 0; i < kFaces.size(); ++i) {
    if (name == kFaces[i]) return i;
  }
  throw Error(fmt::format("{}: \"faces\" is \"{}\", expected materials, both or front", file, name));
}

}  // namespace

void save_replay(const std::filesystem::path& file, const Replay& replay) {
  const LostObject& lost = replay.lost;
  OrderedJson document{{"scene", replay.scene},
                       {"pvs", replay.pvs},
                       {"method", replay.method},
                       {"device", replay.device},
                       {"faces", kFaces[static_cast<std::size_t>(replay.raster_state)]},
                       {"moving", replay.moving},
                       {"samples", replay.samples},
                       {"moves", lost.moves},
                       {"size", {lost.width, lost.height}},
                       {"lost", {{"object", lost.object}, {"pixels", lost.pixels}}},
                       {"views", OrderedJson::array()}};
  if (lost.before) document["views"].push_back(camera::camera_json(*lost.before, lost.origin));
  document["views"].push_back(camera::camera_json(lost.camera, lost.origin));
  io::write_file(file, document.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n");
}

Replay load_replay(const std::filesystem::path& path,
                   const std::function<WorldPoint(const Replay&)>& origin_of) {
  const std::string file = path.string(), text = io::read_file(path, kMostBytes);
  const Json document = Json::parse(text, nullptr, false);
  if (!document.is_object()) throw Error(file + ": expected a replay, which is a JSON object");
  constexpr std::array known{"scene",   "pvs",   "method", "device", "faces", "moving",
                             "samples", "moves", "size",   "lost",   "views"};
  for (const auto& [name, value] : document.items()) {
    if (std::ranges::find(known, name) == known.end())
      throw Error(fmt::format("{}: \"{}\" is no member of a replay", file, name));
  }
  Replay replay;
  replay.scene = member<std::string>(document, "scene", file);
  replay.pvs = member<std::string>(document, "pvs", file);
  replay.method = member<std::string>(document, "method", file);
  replay.device = member<std::string>(document, "device", file);
  replay.raster_state =
      static_cast<RasterState>(raster_state_of(member<std::string>(document, "faces", file), file));
  replay.moving = member<double>(document, "moving", file);
  if (document.contains("samples")) replay.samples = member<std::uint32_t>(document, "samples", file);
  LostObject& lost = replay.lost;
  lost.moves = member<std::size_t>(document, "moves", file);
  if (replay.samples > 64) throw Error(file + ": expected at most 64 \"samples\"");
  if (!(replay.moving >= 0 && replay.moving <= 1) || lost.moves > kMostMoves)
    throw Error(fmt::format("{}: expected \"moving\" from 0 to 1 and at most {} moves", file, kMostMoves));
  const Json& size = part(document, "size", Json::value_t::array, file);
  const auto is_length = [](const Json& side) {
    return is_one<std::uint32_t>(side) && side >= 1 && side <= kMostPixels;
  };
  if (size.size() != 2 || !std::ranges::all_of(size, is_length))
    throw Error(fmt::format("{}: expected \"size\" to be two whole numbers from 1 to {}", file, kMostPixels));
  lost.width = size[0].get<std::uint32_t>(), lost.height = size[1].get<std::uint32_t>();
  const Json& what = part(document, "lost", Json::value_t::object, file);
  lost.object = member<ObjectId>(what, "object", file);
  lost.pixels = member<std::uint64_t>(what, "pixels", file);
  lost.origin = origin_of(replay);
  const std::vector<Camera> cameras =
      camera::read_views(file, part(document, "views", Json::value_t::array, file), lost.origin);
  if (cameras.size() > 2) throw Error(file + ": expected one view, or two of which the last one lost");
  lost.camera = cameras.back();
  if (cameras.size() == 2) lost.before = cameras.front();
  return replay;
}

MethodVerdict look_again(Bench& bench, const Replay& replay) {
  const LostObject& lost = replay.lost;
  if (lost.object >= bench.scene().size())
    throw Error(fmt::format("the replay's \"lost\" names object {}, expected one of the scene's {}",
                            lost.object, bench.scene().size()));
  Mover mover(bench.scene(), replay.moving, 1);
  const auto move = [&] {
    if (replay.moving > 0) bench.update(mover.move());
  };
  for (std::size_t i = 1; i < lost.moves; ++i) move();
  if (lost.before)
    bench.run(bench.subjects().front(), or_throw(make_view(*lost.before, lost.width, lost.height)));
  if (lost.moves > 0) move();
  Verification seen = start_verification(bench);
  examine(bench, bench.subjects().front(), or_throw(make_view(lost.camera, lost.width, lost.height)), lost,
          seen.methods.front());
  return seen.methods.front();
}

}  // namespace sightline::measure
