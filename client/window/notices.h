// What went wrong, across the window's top until it is over or dismissed.
#pragma once

#include <QWidget>

class QLabel;
class QVBoxLayout;

namespace haustra::window {

class Reading;

/// The state of the link while it is down, then what was told as trouble, the newest last.
class Notices : public QWidget {
    Q_OBJECT
public:
    explicit Notices(Reading& reading);

    bool any() const { return linkIsDown_ || told_ > 0; }

protected:
    void changeEvent(QEvent* event) override;

private:
    void look();
    void paint(QWidget& row);
    void tell(const QString& text, bool trouble);
    QWidget* rowOf(const QString& text, bool dismissible);

    Reading& reading_;
    QVBoxLayout* rows_;
    QLabel* link_;
    QWidget* linkRow_;
    bool linkIsDown_ = false;
    int told_ = 0;
};

}  // namespace haustra::window
