// The frame's view; uniform, so that its values are fetched once for all lanes.
layout(set = 0, binding = 0, scalar) uniform ViewBlock {
  ViewData view;
};
