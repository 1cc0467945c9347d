// Parameters with every value drawn at random within its row's range.
#pragma once

#include <cstring>
#include <random>

#include "core/parameter_text.h"
#include "core/parameters.h"

namespace atomesh::test {

inline Parameters random_parameters(unsigned seed, const std::vector<std::string>& species) {
  std::mt19937 random(seed);
  const auto real = [&](double min, double max) {
    switch (random() % 8) {
      case 0:
        return min;
      case 1:
        return max;
      default:
        // A square makes small values as likely as large ones; the ends stay in range whatever the rounding.
        const double t = std::generate_canonical<double, 53>(random);
        return std::min(max, min + t * t * (max - min));
    }
  };
  Parameters parameters;
  for (const std::string& key : parameter_keys(species)) {
    const ParameterRow& row = parameter_row(key);
    const auto component = [&] { return real_text(static_cast<float>(real(row.min, row.max))); };
    switch (row.type) {
      case ParameterType::boolean:
        set_parameter(parameters, key, random() % 2 == 0 ? "true" : "false");
        break;
      case ParameterType::integer:
        set_parameter(parameters, key, std::to_string(static_cast<int>(real(row.min, row.max))));
        break;
      case ParameterType::text:
        set_parameter(parameters, key, std::array{"auto", "Density", "a \"name\" with \\", "µ"}[random() % 4]);
        break;
      case ParameterType::real:
        if (get_parameter(parameters, key) == "auto" && random() % 2 == 0) break;
        set_parameter(parameters, key,
                      row.key.ends_with("intensity") ? component() : real_text(real(row.min, row.max)));
        break;
      case ParameterType::choice:
        set_parameter(parameters, key, row.choices[random() % row.choices.size()]);
        break;
      case ParameterType::rgb:
        set_parameter(parameters, key, component() + "," + component() + "," + component());
        break;
      case ParameterType::rgba:
        set_parameter(parameters, key, component() + "," + component() + "," + component() + "," + component());
        break;
      case ParameterType::vector: {
        // The last one is never zero: normals must not be.
        const std::string last = real_text(static_cast<float>(row.max) * 0.25F);
        set_parameter(parameters, key, component() + "," + component() + "," + last);
        break;
      }
      case ParameterType::color_map: {
        if (random() % 4 == 0) {
          set_parameter(parameters, key, preset_color_map_names()[random() % 5]);
          break;
        }
        const std::size_t count = 2 + random() % 31;
        std::vector<double> scalars(count);
        for (double& s : scalars) s = real(0.0, 1.0);
        std::sort(scalars.begin(), scalars.end());
        ColorMap map;
        const auto channel = [&] { return static_cast<float>(real(0.0, 1.0)); };
        for (const double s : scalars) {
          Vec4f color;
          for (int c = 0; c < 4; ++c) color[c] = channel();
          map.entries.push_back({s, color});
        }
        parameters.volume.color_map = map;
        break;
      }
    }
  }
  return parameters;
}

}  // namespace atomesh::test
