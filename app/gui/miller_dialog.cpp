#include "app/gui/miller_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <cmath>

#include "app/gui/miller_cut.h"
#include "app/gui/navigation.h"
#include "app/gui/number_box.h"
#include "app/gui/parameter_hints.h"
#include "app/gui/workspace.h"
#include "core/error.h"
#include "core/parameter_text.h"

namespace atomesh::gui {

namespace {

constexpr double largest = 1e6;

double number(const NumberBox& box) {
  const auto value = read_real(box.text().toStdString());
  if (!value || std::abs(*value) > largest) {
    throw UsageError("\"" + box.text().toStdString() + "\": expected a number from " + real_text(-largest) + " to " +
                     real_text(largest));
  }
  return *value;
}

}  // namespace

MillerDialog::MillerDialog(Workspace& workspace, int n, QWidget* parent)
    : QDialog(parent),
      workspace_(workspace),
      n_(n),
      before_(workspace.parameters().cut_planes.at(static_cast<std::size_t>(n - 1))),
      offset_(new NumberBox(this)),
      unit_(new QComboBox(this)),
      from_(new QComboBox(this)),
      side_(new QComboBox(this)),
      says_(new QLabel(this)) {
  setObjectName(QStringLiteral("miller_dialog"));
  setWindowTitle(tr("Cut plane %1 by Miller indices").arg(n));
  auto* form = new QFormLayout(this);

  auto* indices = new QHBoxLayout;
  constexpr std::array names{"h", "k", "l"};
  SliderScale scale;
  scale.unit = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    auto* box = hkl_[i] = new NumberBox(this);
    box->setObjectName(QLatin1String(names[i]));
    box->setAccessibleName(QLatin1String(names[i]));
    box->setToolTip(tr("Of the crystal's own (primitive) cell: the plane cuts its edges at 1/h, 1/k, 1/l."));
    box->set_scale(scale);
    box->set_range(-largest, largest);
    indices->addWidget(box);
    connect(box, &NumberBox::entered, this, &MillerDialog::apply);
    connect(box, &NumberBox::stepped, this, &MillerDialog::apply);
  }
  const auto label = [this](const QString& text, QWidget* buddy) {
    auto* made = new QLabel(text, this);
    made->setBuddy(buddy);
    return made;
  };
  form->addRow(label(tr("(&h k l)"), hkl_[0]), indices);

  auto* place = new QHBoxLayout;
  offset_->setObjectName(QStringLiteral("offset"));
  offset_->set_scale(scale);
  offset_->set_range(-largest, largest);
  unit_->setObjectName(QStringLiteral("unit"));
  unit_->addItem(QStringLiteral("Å"), static_cast<int>(MillerCut::Unit::angstrom));
  unit_->addItem(tr("planes"), static_cast<int>(MillerCut::Unit::planes));
  unit_->setToolTip(tr("planes: distances between neighboring planes (hkl)"));
  place->addWidget(offset_);
  place->addWidget(unit_);
  place->addStretch();
  form->addRow(label(tr("&Offset"), offset_), place);
  from_->setObjectName(QStringLiteral("from"));
  from_->addItem(tr("the middle of the sample"));
  from_->addItem(tr("the origin of the file's coordinates"));
  form->addRow(tr("&From"), from_);
  const ParameterRow& side = parameter_row("cut_plane.1.side");
  for (const std::string& choice : side.choices) side_->addItem(choice_label(side, choice));
  side_->setObjectName(QStringLiteral("side"));
  form->addRow(tr("&Side"), side_);
  says_->setObjectName(QStringLiteral("says"));
  says_->setWordWrap(true);
  says_->setTextFormat(Qt::PlainText);
  form->addRow(says_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  form->addRow(buttons);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(offset_, &NumberBox::entered, this, &MillerDialog::apply);
  connect(offset_, &NumberBox::stepped, this, &MillerDialog::apply);
  connect(unit_, &QComboBox::activated, this, &MillerDialog::apply);
  connect(from_, &QComboBox::activated, this, &MillerDialog::apply);
  connect(side_, &QComboBox::activated, this, &MillerDialog::apply);
  connect(this, &QDialog::finished, this, [this] { workspace_.end_gesture(); });
  // The planes of another sample are not this one's to change.
  connect(&workspace_, &Workspace::document_changed, this, [this] { done(QDialog::Accepted); });
  workspace_.end_gesture();
  start_from(before_);
  apply();
}

void MillerDialog::start_from(const CutPlane& plane) {
  const UnitCell& cell = *workspace_.document()->material->unit_cell;
  const auto hkl = miller_indices(cell, plane.normal);
  const Vec3 shown = hkl.value_or(Vec3(1.0, 0.0, 0.0));
  for (int i = 0; i < 3; ++i) hkl_[static_cast<std::size_t>(i)]->show_text(QString::number(shown[i]));
  // A plane that has indices stays where it is; another starts in the middle.
  double offset = 0.0;
  if (hkl) {
    offset =
        plane.distance / glm::length(plane.normal) - glm::dot(plane_normal(cell, *hkl), workspace_.bounds().center());
  }
  offset_->show_text(QString::fromStdString(real_text(offset)));
  side_->setCurrentIndex(static_cast<int>(plane.side));
}

void MillerDialog::apply() {
  const auto& document = workspace_.document();
  if (!document || !document->material->unit_cell) return;
  const UnitCell& cell = *document->material->unit_cell;
  try {
    MillerCut cut;
    for (int i = 0; i < 3; ++i) cut.hkl[i] = number(*hkl_[static_cast<std::size_t>(i)]);
    cut.offset = number(*offset_);
    cut.unit = static_cast<MillerCut::Unit>(unit_->currentData().toInt());
    cut.side = static_cast<CutPlane::Side>(side_->currentIndex());
    const Vec3 from = from_->currentIndex() == 0 ? workspace_.bounds().center() : Vec3(0.0);
    Parameters parameters = workspace_.parameters();
    CutPlane& plane = parameters.cut_planes.at(static_cast<std::size_t>(n_ - 1));
    plane = miller_cut(cell, from, cut);
    workspace_.change(parameters, tr("Cut plane %1 by Miller indices").arg(n_), "miller cut");
    says_->setText(tr("Planes %1 Å apart; %2 x %3 y %4 z = %5 Å")
                       .arg(plane_spacing(cell, cut.hkl), 0, 'g', 5)
                       .arg(plane.normal.x, 0, 'f', 4)
                       .arg((plane.normal.y < 0 ? "− " : "+ ") + QString::number(std::abs(plane.normal.y), 'f', 4))
                       .arg((plane.normal.z < 0 ? "− " : "+ ") + QString::number(std::abs(plane.normal.z), 'f', 4))
                       .arg(plane.distance, 0, 'g', 6));
    for (NumberBox* box : hkl_) box->show_text(box->text());
    offset_->show_text(offset_->text());
  } catch (const Error& error) {
    says_->setText(QStringLiteral("⚠ ") + QString::fromStdString(error.what()));
  }
}

void MillerDialog::reject() {
  Parameters parameters = workspace_.parameters();
  parameters.cut_planes.at(static_cast<std::size_t>(n_ - 1)) = before_;
  workspace_.change(parameters, tr("Cut plane %1 by Miller indices").arg(n_), "miller cut");
  QDialog::reject();
}

}  // namespace atomesh::gui
