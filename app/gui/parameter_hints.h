// What a form shows of a row of the parameter table beside its value: labels, tool tip, how far a slider goes and how
// large a step is; and the search over all rows.
#pragma once

#include <QString>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/parameters.h"

namespace atomesh::gui {

// How a number is moved by a slider and by steps. logarithmic: steps are factors, and where `zero` is set the low end
// of the slider stands for 0.
struct SliderScale {
  static constexpr int positions = 1000;  // a slider goes from 0 to positions

  double low = 0.0;  // ends of the slider; the value may lie beyond
  double high = 1.0;
  bool logarithmic = false;
  bool zero = false;
  bool integer = false;
  double unit = 0.01;  // linear: size of a step

  // The value at a slider's position, with no more digits than the position says.
  double value(int position) const;
  // The position nearest to a value.
  int position(double value) const;
  // `steps` steps up (or down): linear by `unit`, logarithmic by a tenth, at least 1 for integers.
  double stepped(double value, int steps) const;
};

// Of a number's row with a range that a slider can show; nothing for those that go on and on (Å of a plane).
std::optional<SliderScale> slider_scale(const std::string& key);
// The same with what the sample adds: the distance of a cut plane goes over its bounds.
std::optional<SliderScale> slider_scale(const std::string& key, const Parameters& parameters, const Bounds& bounds);
// How arrow keys step a number that has no slider.
SliderScale step_scale(const std::string& key);

// "Face alpha constant"; "Atom-ball colors Na" for a key of a species.
QString parameter_label(const std::string& key);
// Without the heading of the form it stands in: "Position" for light.3.position.
QString short_parameter_label(const std::string& key);
// "Display", "Lights", …: the group, and for numbered rows "Lights, light 3".
QString parameter_place(const std::string& key);
// "Volume and surface" for volume-surface, "≤ (below stays)" for less-equal; else the choice with a capital.
QString choice_label(const ParameterRow& row, const std::string& choice);
// Help, what is accepted, the default and the key; rich text.
QString parameter_tool_tip(const std::string& key);
// The default as text, "auto" where there is such a thing.
std::string default_text(const std::string& key);
// The message of set_parameter without what the field shows anyway: "Expected a number from 0 to 1".
QString field_message(const std::string& message);

// Keys of one group of the table for these species, in its order.
std::vector<std::string> keys_of_group(const std::string& group, const std::vector<std::string>& species = {});
std::vector<std::string> groups();  // in the order of the table
// The group with the parameters of a mode, and the mode of a group (nothing for "Display", "Lights", …).
std::string group_of_mode(Mode mode);
std::optional<Mode> mode_of_group(const std::string& group);

// Keys every word of `query` occurs in (label, key, choices, group, help; upper and lower case alike), best first:
// a label counts more than a key, a key more than the help. None for a query without words.
std::vector<std::string> find_parameters(const QString& query, const std::vector<std::string>& species = {});

}  // namespace atomesh::gui
