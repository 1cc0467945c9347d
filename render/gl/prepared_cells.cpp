#include "render/gl/prepared_cells.h"

#include <cstddef>

namespace atomesh::gl {

void PreparedCells::bind_vertices(const Buffer& vertices) {
  glBindBuffer(GL_ARRAY_BUFFER, vertices.name());
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(FaceVertex), nullptr);
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(FaceVertex),
                        reinterpret_cast<const void*>(offsetof(FaceVertex, behind)));
}

}  // namespace atomesh::gl
