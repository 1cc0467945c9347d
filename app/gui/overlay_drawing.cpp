#include "app/gui/overlay_drawing.h"

#include <QMatrix4x4>
#include <QOpenGLContext>
#include <QOpenGLFunctions>

#include "core/error.h"

namespace atomesh::gui {

namespace {

QOpenGLFunctions& functions() {
  return *QOpenGLContext::currentContext()->functions();
}

}  // namespace

// The texture is bound.
void OverlayDrawing::send(const QImage& image) {
  QOpenGLFunctions& gl = functions();
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    gl.glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  }
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    gl.glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  }
  gl.glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  gl.glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(image.bytesPerLine() / 4));
  gl.glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width(), image.height(), 0, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV,
                  image.constBits());
  gl.glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  sent_ = image.cacheKey();
}

void OverlayDrawing::draw(const QImage& image, int width, int height) {
  QOpenGLFunctions& gl = functions();
  if (!blitter_.isCreated() && !blitter_.create()) {
    throw UnavailableError("OpenGL: the driver does not take the shaders of what lies over the picture");
  }
  if (texture_ == 0) gl.glGenTextures(1, &texture_);
  gl.glActiveTexture(GL_TEXTURE0);
  gl.glBindTexture(GL_TEXTURE_2D, texture_);
  if (sent_ != image.cacheKey()) send(image);
  gl.glViewport(0, 0, width, height);
  gl.glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  for (const GLenum off : {GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_CULL_FACE}) gl.glDisable(off);
  gl.glEnable(GL_BLEND);
  gl.glBlendEquation(GL_FUNC_ADD);
  gl.glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  blitter_.bind();
  blitter_.blit(texture_, QMatrix4x4(), QOpenGLTextureBlitter::OriginTopLeft);
  blitter_.release();
  gl.glDisable(GL_BLEND);
}

void OverlayDrawing::release() {
  if (texture_ != 0) functions().glDeleteTextures(1, &texture_);
  abandon();
}

void OverlayDrawing::abandon() {
  blitter_.destroy();  // Qt's objects know their context, and go with it
  texture_ = 0;
  sent_ = 0;
}

}  // namespace atomesh::gui
