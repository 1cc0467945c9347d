#include "app/gui/crystal_view_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>
#include <cmath>

#include "app/gui/navigation.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

constexpr int most = 99;

struct Shortcut {
  const char* name;
  int kind;
  std::array<int, 3> indices;
};
constexpr std::array<Shortcut, 6> shortcuts{{{"a", 0, {1, 0, 0}},
                                             {"b", 0, {0, 1, 0}},
                                             {"c", 0, {0, 0, 1}},
                                             {"a*", 1, {1, 0, 0}},
                                             {"b*", 1, {0, 1, 0}},
                                             {"c*", 1, {0, 0, 1}}}};

}  // namespace

CrystalViewDialog::CrystalViewDialog(Workspace& workspace, QWidget* parent) : QDialog(parent), workspace_(workspace) {
  setObjectName("crystal_view");
  setWindowTitle(tr("Look along the crystal"));
  auto* all = new QVBoxLayout(this);
  auto* row = new QHBoxLayout;
  kind_ = new QComboBox(this);
  kind_->setObjectName("crystal_view_kind");
  kind_->addItems({tr("Along direction [u v w]"), tr("At plane (h k l)")});
  kind_->setToolTip(tr("[u v w] is u·a + v·b + w·c; (h k l) is looked at along its normal h·a* + k·b* + l·c*"));
  row->addWidget(kind_);
  for (int i = 0; i < 3; ++i) {
    auto* index = new QSpinBox(this);
    index->setObjectName(QString("crystal_view_%1").arg(i + 1));
    index->setRange(-most, most);
    index->setValue(i == 2 ? 1 : 0);
    index->setAccessibleName(tr("Index %1").arg(i + 1));
    row->addWidget(index);
    indices_[static_cast<std::size_t>(i)] = index;
    needing_cell_.push_back(index);
  }
  look_ = new QPushButton(tr("&Look"), this);
  look_->setObjectName("crystal_view_look");
  look_->setDefault(true);
  row->addWidget(look_);
  all->addLayout(row);
  auto* quick = new QHBoxLayout;
  for (const Shortcut& shortcut : shortcuts) {
    auto* button = new QPushButton(shortcut.name, this);
    button->setObjectName(QString("crystal_view_") + shortcut.name);
    button->setToolTip(shortcut.kind == 0 ? tr("Along the cell's edge %1").arg(shortcut.name)
                                          : tr("Along %1, the normal of the other two edges").arg(shortcut.name));
    button->setAutoDefault(false);
    connect(button, &QPushButton::clicked, this, [this, &shortcut] { set_indices(shortcut.kind, shortcut.indices); });
    quick->addWidget(button);
    needing_cell_.push_back(button);
  }
  all->addLayout(quick);
  says_ = new QLabel(this);
  says_->setObjectName("crystal_view_says");
  says_->setWordWrap(true);
  all->addWidget(says_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, this);
  all->addWidget(buttons);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::close);
  connect(look_, &QPushButton::clicked, this, &CrystalViewDialog::look);
  connect(&workspace_, &Workspace::document_changed, this, &CrystalViewDialog::follow_document);
  needing_cell_.push_back(kind_);
  needing_cell_.push_back(look_);
  follow_document();
}

void CrystalViewDialog::follow_document() {
  const auto& document = workspace_.document();
  const bool cell = document && document->material->unit_cell.has_value();
  for (QWidget* widget : needing_cell_) widget->setEnabled(cell);
  if (!cell) {
    says_->setText(document
                       ? tr("This material has no unit cell. Preprocess its file of atoms with one that is found or "
                            "given (Unit cell).")
                       : tr("Open a crystal first."));
    return;
  }
  QStringList lengths;
  for (const Vec3& edge : document->material->unit_cell->primitive) {
    lengths << QString::number(glm::length(edge), 'f', 3);
  }
  says_->setText(tr("Cell: a, b, c = %1 Å").arg(lengths.join(", ")));
}

void CrystalViewDialog::set_indices(int kind, const std::array<int, 3>& indices) {
  kind_->setCurrentIndex(kind);
  for (std::size_t i = 0; i < 3; ++i) indices_[i]->setValue(indices[i]);
  look();
}

void CrystalViewDialog::look() {
  const auto& document = workspace_.document();
  if (!document || !document->material->unit_cell) return;
  const UnitCell& cell = *document->material->unit_cell;
  const Vec3 indices(indices_[0]->value(), indices_[1]->value(), indices_[2]->value());
  const bool plane = kind_->currentIndex() == 1;
  const QString name = QString(plane ? "(%1 %2 %3)" : "[%1 %2 %3]")
                           .arg(indices_[0]->value())
                           .arg(indices_[1]->value())
                           .arg(indices_[2]->value());
  try {
    Parameters parameters = workspace_.parameters();
    if (plane) {
      look_at_plane(parameters, cell, indices);
    } else {
      look_along_crystal(parameters, cell, indices);
    }
    workspace_.change(parameters, tr("Look along %1").arg(name));
    says_->setText(plane
                       ? tr("At plane %1; planes are %2 Å apart").arg(name).arg(plane_spacing(cell, indices), 0, 'f', 3)
                       : tr("Along %1").arg(name));
  } catch (const Error& error) {
    says_->setText(QString::fromUtf8(error.what()));
  }
}

}  // namespace atomesh::gui
