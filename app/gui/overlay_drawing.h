// What lies over the card's picture, drawn by OpenGL itself: Qt's painter keeps objects of the first context it met,
// and ends the program in the next one when that was lost.
#pragma once

#include <QtGui/qopengl.h>

#include <QImage>
#include <QOpenGLTextureBlitter>

namespace atomesh::gui {

// Of one context, which is current in draw() and release().
class OverlayDrawing {
 public:
  // Lays the image (Format_ARGB32_Premultiplied) over the framebuffer that is bound, stretched to width × height pixels
  // from its corner. It is sent only where it is another one than before. Of OpenGL's state the framebuffer that is
  // bound stays as it was. Throws UnavailableError where the driver does not take the shaders.
  void draw(const QImage& image, int width, int height);
  // Gives back what lies on the card; the next draw() makes it again. Without it that stays until the context goes.
  void release();
  // The same without a context: it is gone, and what lay on the card with it.
  void abandon();

 private:
  void send(const QImage& image);

  QOpenGLTextureBlitter blitter_;
  GLuint texture_ = 0;
  qint64 sent_ = 0;  // QImage::cacheKey()
};

}  // namespace atomesh::gui
