#include "app/gui/section.h"

#include <QHBoxLayout>
#include <QToolButton>
#include <QVBoxLayout>

namespace atomesh::gui {

Section::Section(const QString& title, const QString& help, QWidget* parent)
    : QWidget(parent),
      title_(new QToolButton(this)),
      heading_(new QHBoxLayout),
      content_(new QWidget(this)),
      lines_(new QVBoxLayout(content_)) {
  setObjectName(QStringLiteral("section ") + title);
  title_->setObjectName(objectName() + QStringLiteral("/fold"));
  title_->setText(title);
  title_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  title_->setArrowType(Qt::DownArrow);
  title_->setAutoRaise(true);
  title_->setFocusPolicy(Qt::StrongFocus);
  title_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  title_->setToolTip(tr("Show or hide"));
  QFont font = title_->font();
  font.setBold(true);
  title_->setFont(font);
  heading_->setContentsMargins(0, 0, 0, 0);
  heading_->setSpacing(2);
  heading_->addWidget(title_, 1);
  if (!help.isEmpty()) {
    auto* button = new QToolButton(this);
    button->setObjectName(objectName() + QStringLiteral("/help"));
    button->setText(QStringLiteral("?"));
    button->setAutoRaise(true);
    button->setToolTip(tr("Help: %1").arg(title));
    button->setAccessibleName(button->toolTip());
    heading_->addWidget(button);
    connect(button, &QToolButton::clicked, this, [this, help] { emit help_requested(help); });
  }
  const int indent = fontMetrics().averageCharWidth();
  lines_->setContentsMargins(indent, 0, 0, indent);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(2);
  layout->addLayout(heading_);
  layout->addWidget(content_);
  connect(title_, &QToolButton::clicked, this, [this] { set_folded(!folded_); });
}

void Section::add(QWidget* widget) {
  lines_->addWidget(widget);
}

void Section::add_to_heading(QWidget* widget) {
  heading_->insertWidget(1, widget);
}

void Section::set_folded(bool folded) {
  if (folded == folded_) return;
  folded_ = folded;
  content_->setVisible(!folded);
  title_->setArrowType(folded ? Qt::RightArrow : Qt::DownArrow);
  emit folded_changed(folded);
}

void Section::set_title(const QString& title) {
  title_->setText(title);
}

}  // namespace atomesh::gui
