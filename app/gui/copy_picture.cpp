#include "app/gui/copy_picture.h"

#include <QClipboard>
#include <QGuiApplication>
#include <algorithm>
#include <cmath>

namespace atomesh::gui {

QImage to_clipboard_image(const Image& image) {
  QImage out(image.width, image.height, QImage::Format_RGBA8888);
  for (int row = 0; row < image.height; ++row) {
    uchar* byte = out.scanLine(row);
    for (int column = 0; column < image.width; ++column) {
      const Vec4f& pixel = image.at(column, row);
      for (int c = 0; c < 4; ++c) {
        // Written so that NaN becomes 0.
        const float channel = pixel[c] > 0.0F ? std::min(pixel[c], 1.0F) : 0.0F;
        *byte++ = static_cast<uchar>(std::lround(channel * 255.0F));
      }
    }
  }
  return out;
}

PictureCopier::PictureCopier(Workspace& workspace, QObject* parent) : QObject(parent), workspace_(workspace) {}

PictureCopier::~PictureCopier() = default;

void PictureCopier::copy() {
  if (!workspace_.document()) return;
  const ViewOptions& options = workspace_.view_options();
  PictureSettings settings;
  settings.width = workspace_.width();
  settings.height = workspace_.height();
  settings.parts = {.legend = options.legend, .scale_bar = options.scale_bar, .tripod = options.tripod};
  settings.marks = workspace_.marks();
  settings.picks = workspace_.picks();
  const auto result = std::make_shared<QImage>();
  job_ = std::make_unique<Job>(
      tr("Copying the picture"),
      [result, settings, document = *workspace_.document(), parameters = workspace_.shown()](Progress& progress) {
        const PictureStudio studio(document, parameters, settings, progress);
        *result = to_clipboard_image(studio.draw(studio.parameters(), std::nullopt, progress));
      },
      nullptr, Job::Unheeded::leave);
  connect(job_.get(), &Job::done, this, [this, result] {
    job_.release()->deleteLater();
    QGuiApplication::clipboard()->setImage(*result);
    workspace_.say(tr("Copied a picture of %1 × %2 pixels").arg(result->width()).arg(result->height()));
    emit copied();
  });
  connect(job_.get(), &Job::failed, this, [this](const QString& message) {
    job_.release()->deleteLater();
    workspace_.complain(message);
  });
  emit started(job_.get());
  job_->start();
}

}  // namespace atomesh::gui
