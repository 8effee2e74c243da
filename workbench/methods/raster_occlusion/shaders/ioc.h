#include "tree.h"

layout(push_constant, scalar) uniform Push {
  NodeBuffer nodes;
  WordBuffer children, parents, marks, seen;
  WordBuffer list, next_list;
  TestBuffer test, next_test;
  uint interior, total;
};
