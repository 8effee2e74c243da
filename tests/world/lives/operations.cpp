#include "world/lives/operations.hpp"

#include <array>

namespace sightline::lives {

const Operation& any_operation(Random& random) {
  static constexpr std::array kAll{
      Operation{"insert", 10, insert},
      Operation{"remove", 5, remove},
      Operation{"move", 22, move},
      Operation{"rest", 2, rest},
      Operation{"keep moving", 3, keep_moving},
      Operation{"give columns", 6, give_columns},
      Operation{"carry", 3, carry},
      Operation{"move the world", 1, move_the_world},
      Operation{"check all", 2, check_all},
      Operation{"cull", 14, cull_views},
      Operation{"walk", 2, walk},
      Operation{"cull automatically", 4, cull_automatically},
      Operation{"hide", 3, hide},
      Operation{"inspect", 2, inspect},
      Operation{"cull ranges", 6, cull_ranges},
      Operation{"leave the order stale", 1, leave_the_order_stale},
      Operation{"cull instances", 3, cull_instances},
      Operation{"save and load", 2, save_and_load},
      Operation{"begin a stream", 1, begin_stream},
      Operation{"stream", 4, stream},
      Operation{"refuse a change", 3, refuse_change},
      Operation{"refuse a cull", 3, refuse_cull},
  };
  std::uint32_t total = 0;
  for (const Operation& operation : kAll) total += operation.weight;
  std::uint32_t left = random.below(total);
  for (const Operation& operation : kAll) {
    if (left < operation.weight) return operation;
    left -= operation.weight;
  }
  return kAll.back();
}

}  // namespace sightline::lives
