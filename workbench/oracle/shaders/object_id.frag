#version 460
layout(location = 2) in flat uint object;
layout(location = 0) out uint id;

void main() {
  id = object;
}
