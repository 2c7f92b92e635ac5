// The flat map's surface as a camera sees it.
void main() { gl_Position = projected(flatVertices[gl_VertexID].placeMm - wall.eyeMm); }
