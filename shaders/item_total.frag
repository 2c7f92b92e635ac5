// N_total: the pixels of each observed triangle, whatever stands before them (dissertation §2.4).
in vec3 fromEyeMm;
layout(std430, binding = 2) buffer Observed { uint observed[]; };
layout(std430, binding = 3) buffer Total { uint total[]; };

void main() {
    int triangle = wall.firstTriangle + gl_PrimitiveID;
    if (observed[triangle] > 0u) atomicAdd(total[triangle], 1u);
}
