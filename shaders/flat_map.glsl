// The flat map as every entry point that draws the flattened wall reads it.
layout(std140, binding = 1) uniform FlatBlock { FlatUniforms flatWindow; };
layout(std430, binding = 0) readonly buffer FlatVertices { FlatVertex flatVertices[]; };
