// Words of the window's top line where it is narrow: they end in an ellipsis, and are never cut at
// their front.
#pragma once

#include <QLabel>
#include <QToolButton>

namespace haustra::window {

/// A label of one line that shows as much of its text as it has room for.
class NarrowLabel : public QLabel {
public:
    using QLabel::QLabel;
    QSize minimumSizeHint() const override { return {0, QLabel::minimumSizeHint().height()}; }

protected:
    void paintEvent(QPaintEvent*) override;
};

/// A button of text alone likewise, the first words of which it has always room for.
class NarrowButton : public QToolButton {
public:
    using QToolButton::QToolButton;
    /// `whole` begins with `least`.
    void setWords(const QString& whole, const QString& least);
    QSize sizeHint() const override { return hintFor(whole_); }
    QSize minimumSizeHint() const override { return hintFor(least_); }

protected:
    void resizeEvent(QResizeEvent* event) override;

private:
    QSize hintFor(const QString& words) const;
    void fit();

    QString whole_, least_;
};

}  // namespace haustra::window
