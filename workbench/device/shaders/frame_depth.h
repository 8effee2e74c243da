// The frame's depth so far, between Image::begin_reading() and end_reading().
layout(set = 0, binding = 1) uniform sampler2D frame_depth;
