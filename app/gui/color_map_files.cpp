#include "app/gui/color_map_files.h"

#include <QByteArray>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <algorithm>
#include <cmath>
#include <functional>

#include "app/gui/color_map_edit.h"
#include "core/error.h"
#include "core/image.h"
#include "core/text_file.h"

namespace atomesh::gui {

namespace {

// `stride` numbers for each point, the first of them its scalar: finite, ascending.
std::vector<double> numbers_of(const QJsonValue& list, std::size_t stride, const char* what, const std::string& path) {
  std::vector<double> numbers;
  for (const QJsonValue& value : list.toArray()) {
    if (!value.isDouble() || !std::isfinite(value.toDouble())) {
      throw InputError(path, 0, std::string(what) + " holds something that is no number");
    }
    numbers.push_back(value.toDouble());
  }
  if (numbers.size() < 2 * stride || numbers.size() % stride != 0) {
    throw InputError(path, 0,
                     std::string(what) + " must hold " + std::to_string(stride) + " numbers for each of two or more " +
                         "points, not " + std::to_string(numbers.size()) + " in all");
  }
  for (std::size_t i = stride; i < numbers.size(); i += stride) {
    if (numbers[i] < numbers[i - stride]) throw InputError(path, 0, std::string(what) + ": its scalars descend");
  }
  if (!(numbers[numbers.size() - stride] > numbers[0])) {
    throw InputError(path, 0, std::string(what) + ": all its points have the same scalar");
  }
  return numbers;
}

ColorMap map_of(const std::vector<double>& numbers, std::size_t stride, double low, double high,
                const std::function<Vec4f(const double*)>& color) {
  ColorMap map;
  for (std::size_t i = 0; i < numbers.size(); i += stride) {
    const double scalar = (0.5 * numbers[i] - 0.5 * low) / (0.5 * high - 0.5 * low);
    map.entries.push_back({std::clamp(scalar, 0.0, 1.0), glm::clamp(color(&numbers[i]), 0.0F, 1.0F)});
  }
  return map;
}

ColorMapFile from_json(const QByteArray& bytes, const std::string& path) {
  QJsonParseError error;
  const QJsonDocument document = QJsonDocument::fromJson(bytes, &error);
  if (document.isNull()) throw InputError(path, 0, "is no JSON: " + error.errorString().toStdString());
  const QJsonArray list = document.isArray() ? document.array() : QJsonArray{document.object()};
  const auto found = std::find_if(list.begin(), list.end(),
                                  [](const QJsonValue& one) { return one.toObject().contains("RGBPoints"); });
  if (found == list.end()) throw InputError(path, 0, "has no color map with RGBPoints, as ParaView writes them");
  const QJsonObject object = found->toObject();
  const std::vector<double> colors = numbers_of(object["RGBPoints"], 4, "RGBPoints", path);
  const double low = colors.front();
  const double high = colors[colors.size() - 4];
  ColorMapFile file;
  file.map = map_of(colors, 4, low, high, [](const double* p) { return Vec4f(Vec3f(Vec3(p[1], p[2], p[3])), 1.0F); });
  if (object.contains("Points")) {
    // ParaView's midpoints and sharpness are 0.5 and 0 unless somebody changed them; they are passed over.
    const std::vector<double> points = numbers_of(object["Points"], 4, "Points", path);
    const ColorMap opacities = map_of(points, 4, points.front(), points[points.size() - 4], [](const double* p) {
      return Vec4f(0.0F, 0.0F, 0.0F, static_cast<float>(p[1]));
    });
    file.map = combined_map(file.map, opacities);
    file.opacities = true;
  }
  const QString space = object["ColorSpace"].toString("RGB");
  if (space != "RGB") {
    file.note = "ParaView goes from color to color in the space " + space.toStdString() + ", atomesh in RGB.";
  }
  if (list.size() > 1) {
    file.note += std::string(file.note.empty() ? "" : " ") + "The file holds " + std::to_string(list.size()) +
                 " maps; the first was taken.";
  }
  return file;
}

ColorMapFile from_picture(const Image& picture) {
  const bool lying = picture.width >= picture.height;
  const int length = lying ? picture.width : picture.height;
  ColorMapFile file;
  for (int i = 0; i < length; ++i) {
    const Vec4f color = lying ? picture.at(i, picture.height / 2) : picture.at(picture.width / 2, length - 1 - i);
    const double scalar = length > 1 ? static_cast<double>(i) / (length - 1) : 0.0;
    file.map.entries.push_back({scalar, color});
    file.opacities = file.opacities || color.a < 1.0F;
  }
  if (length == 1) file.map.entries.push_back({1.0, file.map.entries.front().color});
  return file;
}

}  // namespace

ColorMapFile read_color_map_file(const std::string& path) {
  ColorMapFile file;
  if (is_png_file(path)) {
    file = from_picture(read_png(path));
  } else {
    const MappedFile bytes(path);
    const std::string_view text = bytes.bytes();
    file = from_json(QByteArray(text.data(), static_cast<qsizetype>(text.size())), path);
  }
  file.map = fewer_entries(file.map);
  check_color_map(file.map);
  return file;
}

void write_color_map_file(const std::string& path, const ColorMap& map, const std::string& name) {
  QJsonArray colors;
  QJsonArray opacities;
  for (const ColorMapEntry& e : map.entries) {
    colors << e.scalar;
    for (int c = 0; c < 3; ++c) colors << static_cast<double>(e.color[c]);
    opacities << e.scalar << static_cast<double>(e.color.a) << 0.5 << 0.0;
  }
  const QJsonObject object{
      {"Name", QString::fromStdString(name)}, {"ColorSpace", "RGB"}, {"RGBPoints", colors}, {"Points", opacities}};
  const QByteArray text = QJsonDocument(QJsonArray{object}).toJson();
  AtomicFile file(path);
  file.write(text.constData(), static_cast<std::size_t>(text.size()));
  file.commit();
}

}  // namespace atomesh::gui
