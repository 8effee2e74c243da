// Worlds as bytes.
#include <sightline/snapshot.hpp>

#include <cstring>

#include "bindings/c/calls.hpp"

struct sightline_world_stream {
  sightline::WorldStream stream;
};

using namespace sightline;
using namespace sightline::c_api;

namespace {

static_assert(SIGHTLINE_SECTOR_OUT == static_cast<int>(SectorState::out) &&
              SIGHTLINE_SECTOR_COMING == static_cast<int>(SectorState::coming) &&
              SIGHTLINE_SECTOR_IN == static_cast<int>(SectorState::in) &&
              SIGHTLINE_SECTOR_CHANGED == static_cast<int>(SectorState::changed) &&
              SIGHTLINE_SECTOR_DAMAGED == static_cast<int>(SectorState::damaged));
static_assert(sizeof(sightline_box) == sizeof(WorldBox));

Status take_bytes(const void* bytes, std::size_t size, std::span<const std::byte>& out) {
  const auto* data = static_cast<const std::byte*>(bytes);
  if (!can_hold(data, size))
    return {StatusCode::bad_argument, "snapshot: the bytes are NULL, or more than memory holds"};
  out = {data, size};
  return {};
}

Status take_options(const sightline_stream_options* given, StreamOptions& options) {
  sightline_stream_options o = sightline_stream_options_default();
  if (given &&
      (!take_struct(given, SIGHTLINE_FIRST_SIZE(sightline_stream_options, ahead), o) || o.reserved != 0))
    return {StatusCode::bad_argument,
            "stream: a struct_size is unknown, expected that of sightline_stream_options_default"};
  constexpr std::uint64_t kMost = std::numeric_limits<std::size_t>::max();
  options = {static_cast<std::size_t>(o.budget < kMost ? o.budget : kMost), o.ahead};
  return {};
}

// update() or bring_in().
using StreamCall = Result<StreamReport> (WorldStream::*)(std::span<const CullView>, const StreamOptions&);
sightline_status call_with(StreamCall call, sightline_world_stream* stream, const sightline_cull_view* views,
                           std::size_t count, const sightline_stream_options* options,
                           sightline_stream_report* report) {
  if (!stream || !views) return refuse("stream: the stream or the views are NULL");
  Views seen;
  StreamOptions given;
  if (const Status ok = take(views, count, seen); !ok) return keep(ok);
  if (const Status ok = take_options(options, given); !ok) return keep(ok);
  const Result<StreamReport> found = (stream->stream.*call)({seen.data(), count}, given);
  if (!found) return keep(found.error());
  if (report) *report = {found->in, found->coming, found->missing, found->damaged, found->memory};
  return SIGHTLINE_OK;
}

static_assert(sizeof(sightline_handle) == sizeof(Handle) && alignof(sightline_handle) == alignof(Handle) &&
              offsetof(sightline_handle, generation) == offsetof(Handle, generation));

// came() or went().
using Passed = std::span<const Handle> (WorldStream::*)() const noexcept;
sightline_status list(Passed passed, const sightline_world_stream* stream, const sightline_handle** handles,
                      std::size_t* count) {
  if (!stream || !handles || !count) return refuse("stream: the stream or a place for the handles is NULL");
  const std::span<const Handle> of = (stream->stream.*passed)();
  *handles = reinterpret_cast<const sightline_handle*>(of.data()), *count = of.size();
  return SIGHTLINE_OK;
}

}  // namespace

extern "C" {

sightline_status sightline_world_save(const sightline_world* world,
                                      int (*sink)(void* user, const void* bytes, size_t size), void* user) {
  if (!world || !sink) return refuse("save: the world or the sink is NULL");
  struct Caller {
    int (*sink)(void*, const void*, size_t);
    void* user;
  } caller{sink, user};
  const SnapshotSink handing{[](void* to, std::span<const std::byte> bytes) {
                               const auto& c = *static_cast<const Caller*>(to);
                               return c.sink(c.user, bytes.data(), bytes.size()) != 0;
                             },
                             &caller};
  return keep(save(world->world, handing));
}

sightline_status sightline_world_load(const void* bytes, size_t size, sightline_world** world) {
  std::span<const std::byte> given;
  if (!world) return refuse("load: the place for the world is NULL");
  if (const Status ok = take_bytes(bytes, size, given); !ok) return keep(ok);
  Result<World> loaded = load(given);
  if (!loaded) return keep(loaded.error());
  *world = new sightline_world{*std::move(loaded)};
  return SIGHTLINE_OK;
}

sightline_status sightline_world_stream_open(const void* bytes, size_t size, sightline_world* world,
                                             sightline_world_stream** stream) {
  std::span<const std::byte> given;
  if (!world || !stream) return refuse("stream: the world or the place for the stream is NULL");
  if (const Status ok = take_bytes(bytes, size, given); !ok) return keep(ok);
  Result<WorldStream> opened = WorldStream::open(given, world->world);
  if (!opened) return keep(opened.error());
  *stream = new sightline_world_stream{*std::move(opened)};
  return SIGHTLINE_OK;
}
void sightline_world_stream_destroy(sightline_world_stream* stream) {
  delete stream;
}

size_t sightline_world_stream_size(const sightline_world_stream* stream) {
  return stream ? stream->stream.size() : 0;
}

sightline_status sightline_world_stream_sector(const sightline_world_stream* stream, size_t index,
                                               sightline_stream_sector* sector) {
  if (!stream || !sector || index >= stream->stream.size())
    return refuse("stream: a pointer is NULL, or there is no such sector");
  const StreamSector s = stream->stream.sector(index);
  *sector = {};
  std::memcpy(&sector->bounds, &s.bounds, sizeof s.bounds);
  sector->objects = s.objects, sector->memory = s.memory, sector->first_byte = s.first_byte;
  sector->error = s.error ? nullptr : s.error.message();
  sector->state = static_cast<std::uint32_t>(s.state);
  return SIGHTLINE_OK;
}

int sightline_world_stream_stands_out(const sightline_world_stream* stream, sightline_handle handle) {
  return stream && stream->stream.stands_out(handle_of(handle));
}

sightline_status sightline_world_stream_update(sightline_world_stream* stream,
                                               const sightline_cull_view* views, size_t view_count,
                                               const sightline_stream_options* options,
                                               sightline_stream_report* report) {
  return call_with(&WorldStream::update, stream, views, view_count, options, report);
}

int sightline_world_stream_work(sightline_world_stream* stream) {
  return stream && stream->stream.work();
}

sightline_status sightline_world_stream_bring_in(sightline_world_stream* stream,
                                                 const sightline_cull_view* views, size_t view_count,
                                                 const sightline_stream_options* options,
                                                 sightline_stream_report* report) {
  return call_with(&WorldStream::bring_in, stream, views, view_count, options, report);
}

sightline_status sightline_world_stream_came(const sightline_world_stream* stream,
                                             const sightline_handle** handles, size_t* count) {
  return list(&WorldStream::came, stream, handles, count);
}
sightline_status sightline_world_stream_went(const sightline_world_stream* stream,
                                             const sightline_handle** handles, size_t* count) {
  return list(&WorldStream::went, stream, handles, count);
}

}  // extern "C"
