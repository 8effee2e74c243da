// What may happen to a world. To add something, write a function here and give it a weight in operations.cpp:
// it changes every lane and the model alike, and fails the test where they differ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "world/lives/life.hpp"

namespace sightline::lives {

struct Operation {
  const char* name;
  std::uint32_t weight;  // how often it happens
  void (*run)(Life&);
};
const Operation& any_operation(Random& random);

// changes.cpp: objects come, move, go and are given columns.
void insert(Life& life);
void insert(Life& life, std::size_t count);
void remove(Life& life);
void remove(Life& life, std::size_t count);
void move(Life& life);
/// A step each.
void step(Life& life, const std::vector<ObjectId>& who);
void rest(Life& life);
void keep_moving(Life& life);
void give_columns(Life& life);
void carry(Life& life);
void move_the_world(Life& life);
void check_all(Life& life);

// culls.cpp: what views see.
void cull_views(Life& life);
void walk(Life& life);
void cull_automatically(Life& life);
void hide(Life& life);
void inspect(Life& life);

// orders.cpp and instances.cpp: the same in other forms.
/// Brings a lane's order up to date, or numbers it anew, and holds its report.
void follow_order(Life& life, Lane& lane, bool anew = false);
void cull_ranges(Life& life);
void leave_the_order_stale(Life& life);
void cull_instances(Life& life);

// snapshots.cpp: worlds as bytes.
void save_and_load(Life& life);
void begin_stream(Life& life);
void stream(Life& life);

// refusals.cpp: what is refused leaves all as it is.
void refuse_change(Life& life);
void refuse_cull(Life& life);

}  // namespace sightline::lives
