#include "app/gui/parameter_hints.h"

#include <QCoreApplication>
#include <QStringList>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/parameter_text.h"

namespace atomesh::gui {

namespace {

constexpr std::string_view species_mark = "<species>";
constexpr double decades = 1000.0;  // a range that spans as much is moved through by factors

QString tr(const char* text) {
  return QCoreApplication::translate("parameter_hints", text);
}

// With so many significant digits.
double rounded(double value, int digits) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value)))) - digits + 1;
  // Both ways by a power of ten that is exact, so that 0.3 comes out as the double nearest to 0.3.
  const double power = std::pow(10.0, std::abs(exponent));
  return exponent < 0 ? std::round(value * power) / power : std::round(value / power) * power;
}

// The largest of 1, 2, 5 times a power of ten that is not above `step`.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= step * (1 + 1e-9)) return factor * power;
  }
  return power;
}

double multiple(double value, double unit) {
  // Divided by a whole number where the unit is one's part: 0.07, not 7 × 0.01 = 0.07000000000000001.
  const double parts = std::round(1.0 / unit);
  const double count = std::round(value / unit);
  return parts >= 1.0 && std::abs(parts * unit - 1.0) < 1e-9 ? count / parts : count * unit;
}

SliderScale linear_scale(double low, double high, const ParameterRow& row) {
  SliderScale scale;
  scale.low = low;
  scale.high = high;
  scale.integer = row.type == ParameterType::integer;
  scale.unit = scale.integer || row.unit == "degrees" ? 1.0 : round_step((high - low) / 100.0);
  return scale;
}

SliderScale logarithmic_scale(double low, double high, bool zero, const ParameterRow& row) {
  SliderScale scale;
  scale.low = low;
  scale.high = high;
  scale.logarithmic = true;
  scale.zero = zero;
  scale.integer = row.type == ParameterType::integer;
  return scale;
}

bool is_number(const ParameterRow& row) {
  return row.type == ParameterType::integer || row.type == ParameterType::real;
}

// "light.3.position" → the name of its part of the group, "Light 3".
QString numbered_part(const std::string& key) {
  const bool light = key.starts_with("light.");
  if (!light && !key.starts_with("cut_plane.")) return {};
  const std::size_t dot = key.find('.');
  const std::string number = key.substr(dot + 1, key.find('.', dot + 1) - dot - 1);
  return (light ? QStringLiteral("Light ") : QStringLiteral("Cut plane ")) + QString::fromStdString(number);
}

QString species_of(const std::string& key) {
  const std::string& row_key = parameter_row(key).key;
  if (!row_key.ends_with(species_mark) || row_key == key) return {};
  return QString::fromStdString(key.substr(row_key.size() - species_mark.size()));
}

QString capitalized(QString text) {
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  return text;
}

}  // namespace

double SliderScale::value(int position) const {
  const double t = std::clamp(position, 0, positions) / static_cast<double>(positions);
  if (position <= 0) return zero ? 0.0 : low;
  if (position >= positions) return high;
  double value = 0.0;
  if (logarithmic) {
    value = rounded(low * std::pow(high / low, t), 3);
  } else {
    const double fine = round_step((high - low) / positions);
    value = multiple(low + t * (high - low), integer ? 1.0 : std::min(fine, unit));
  }
  return std::clamp(integer ? std::round(value) : value, low, high);
}

int SliderScale::position(double value) const {
  if (!(value > low)) return 0;
  if (value >= high) return positions;
  const double t = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return static_cast<int>(std::lround(t * positions));
}

double SliderScale::stepped(double value, int steps) const {
  if (!logarithmic) {
    // From 0.123 to the multiples of the step, not to 0.133.
    const double down = std::floor(value / unit + 1e-9);
    const double up = std::ceil(value / unit - 1e-9);
    return multiple((steps > 0 ? down : up) * unit + steps * unit, unit);
  }
  for (int i = 0; i < std::abs(steps); ++i) {
    if (steps > 0) {
      value = value <= 0.0 ? low : integer ? std::max(value + 1, std::round(value * 1.1)) : rounded(value * 1.1, 2);
    } else if (value <= low * (1 + 1e-9)) {
      value = zero ? 0.0 : low;
    } else {
      value = integer ? std::min(value - 1, std::round(value / 1.1)) : rounded(value / 1.1, 2);
    }
  }
  return value;
}

std::optional<SliderScale> slider_scale(const std::string& key) {
  const ParameterRow& row = parameter_row(key);
  if (!is_number(row)) return {};
  const double span = row.max - row.min;
  if (row.min > 0.0 && row.max / row.min >= decades) return logarithmic_scale(row.min, row.max, false, row);
  if (row.min == 0.0 && row.max > 10.0) {
    // The table allows what physics could ask for; the slider moves about what one starts from.
    const double usual = read_real(default_text(key)).value_or(0.0);
    const double middle = usual > 0.0 ? usual : 1.0;
    return logarithmic_scale(middle / decades, std::min(row.max, middle * decades), true, row);
  }
  if (span <= 2 * decades) return linear_scale(row.min, row.max, row);
  return {};
}

std::optional<SliderScale> slider_scale(const std::string& key, const Parameters& parameters, const Bounds& bounds) {
  if (!key.starts_with("cut_plane.") || !key.ends_with(".distance")) return slider_scale(key);
  if (bounds.empty()) return {};
  const std::size_t n = static_cast<std::size_t>(key[10] - '1');
  const Vec3& normal = parameters.cut_planes.at(n).normal;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) != 0 ? bounds.max.x : bounds.min.x, (corner & 2) != 0 ? bounds.max.y : bounds.min.y,
                 (corner & 4) != 0 ? bounds.max.z : bounds.min.z);
    low = std::min(low, glm::dot(normal, p));
    high = std::max(high, glm::dot(normal, p));
  }
  if (!(high > low)) return {};
  // Outwards to whole steps: the ends are numbers to read, and beyond the last atom.
  const double unit = round_step((high - low) / 100.0);
  return linear_scale(multiple(std::floor(low / unit) * unit, unit), multiple(std::ceil(high / unit) * unit, unit),
                      parameter_row(key));
}

SliderScale step_scale(const std::string& key) {
  if (const auto scale = slider_scale(key)) return *scale;
  SliderScale scale;
  const ParameterRow& row = parameter_row(key);
  scale.integer = row.type == ParameterType::integer;
  scale.unit = scale.integer ? 1.0 : 0.1;
  return scale;
}

QString parameter_label(const std::string& key) {
  const QString label = QString::fromStdString(parameter_row(key).label);
  const QString species = species_of(key);
  return species.isEmpty() ? label : label + QLatin1Char(' ') + species;
}

QString short_parameter_label(const std::string& key) {
  const QString label = QString::fromStdString(parameter_row(key).label);
  if (!species_of(key).isEmpty()) {
    const std::size_t dot = key.find('.');
    return capitalized(QString::fromStdString(key.substr(dot + 1, key.find('.', dot + 1) - dot - 1)));
  }
  const QString part = numbered_part(key);
  if (part.isEmpty() || !label.startsWith(part)) return label;
  const QString rest = label.mid(part.size() + 1);
  return rest.size() <= 2 || rest.contains(QLatin1Char(',')) ? rest : capitalized(rest);  // d and a, b, c are symbols
}

QString parameter_place(const std::string& key) {
  const QString group = QString::fromStdString(parameter_row(key).group);
  const QString part = numbered_part(key);
  return part.isEmpty() ? group : group + QStringLiteral(", ") + part.toLower();
}

QString choice_label(const ParameterRow& row, const std::string& choice) {
  if (row.key == "mode") return QString::fromStdString(group_of_mode(mode_from_name(choice)));
  if (choice == "less-equal") return tr("≤ (below stays)");
  if (choice == "greater-equal") return tr("≥ (above stays)");
  return capitalized(QString::fromStdString(choice));
}

QString parameter_tool_tip(const std::string& key) {
  const ParameterRow& row = parameter_row(key);
  const auto html = [](const std::string& text) { return QString::fromStdString(text).toHtmlEscaped(); };
  return QStringLiteral("<p>%1</p><p>%2<br>%3<br><code>%4</code></p>")
      .arg(html(row.help), capitalized(html(expected_value(row))), tr("Default: %1").arg(html(default_text(key))),
           html(key));
}

std::string default_text(const std::string& key) {
  static const Parameters defaults;
  return get_parameter(defaults, key);
}

QString field_message(const std::string& message) {
  const std::size_t at = message.find(": expected ");
  if (at != std::string::npos) return capitalized(QString::fromStdString(message.substr(at + 2)));
  const std::size_t colon = message.find(": ");
  return capitalized(QString::fromStdString(colon == std::string::npos ? message : message.substr(colon + 2)));
}

std::vector<std::string> keys_of_group(const std::string& group, const std::vector<std::string>& species) {
  std::vector<std::string> keys = parameter_keys(species);
  std::erase_if(keys, [&](const std::string& key) { return parameter_row(key).group != group; });
  return keys;
}

std::vector<std::string> groups() {
  std::vector<std::string> names;
  for (const ParameterRow& row : parameter_table()) {
    if (names.empty() || names.back() != row.group) names.push_back(row.group);
  }
  return names;
}

std::string group_of_mode(Mode mode) {
  // The mode's rows begin with its name.
  std::string prefix = std::string(mode_name(mode)) + ".";
  std::replace(prefix.begin(), prefix.end(), '-', '_');
  for (const ParameterRow& row : parameter_table()) {
    if (row.key.starts_with(prefix)) return row.group;
  }
  return {};
}

std::optional<Mode> mode_of_group(const std::string& group) {
  for (const Mode mode : {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms}) {
    if (group_of_mode(mode) == group) return mode;
  }
  return {};
}

std::vector<std::string> find_parameters(const QString& query, const std::vector<std::string>& species) {
  const QStringList words = query.simplified().split(QLatin1Char(' '), Qt::SkipEmptyParts);
  if (words.isEmpty()) return {};
  struct Hit {
    std::string key;
    int score;
  };
  std::vector<Hit> hits;
  for (const std::string& key : parameter_keys(species)) {
    const ParameterRow& row = parameter_row(key);
    QString choices;
    for (const std::string& choice : row.choices) {
      choices += QLatin1Char(' ') + QString::fromStdString(choice) + QLatin1Char(' ') + choice_label(row, choice);
    }
    // What is looked through, and what a word that begins there counts.
    const std::array<std::pair<QString, int>, 5> places{{{parameter_label(key), 16},
                                                         {QString::fromStdString(key), 12},
                                                         {choices, 8},
                                                         {QString::fromStdString(row.group), 6},
                                                         {QString::fromStdString(row.help), 2}}};
    int score = 0;
    bool all = true;
    for (const QString& word : words) {
      int best = 0;
      for (const auto& [text, weight] : places) {
        const qsizetype at = text.indexOf(word, 0, Qt::CaseInsensitive);
        if (at < 0) continue;
        best = std::max(best, at == 0 || !text[at - 1].isLetterOrNumber() ? weight : weight / 2);
      }
      all = all && best > 0;
      score += best;
    }
    if (all) hits.push_back({key, score});
  }
  std::stable_sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.score > b.score; });
  std::vector<std::string> keys;
  for (Hit& hit : hits) keys.push_back(std::move(hit.key));
  return keys;
}

}  // namespace atomesh::gui
