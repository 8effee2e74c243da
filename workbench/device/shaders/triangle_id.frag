#version 460

layout(location = 1) in flat uint object;
layout(location = 0) out uint id;

void main() {
  id = object;
}
