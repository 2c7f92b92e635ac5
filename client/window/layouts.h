// Where the panes lie.
#pragma once

#include <QByteArray>
#include <QStringList>
#include <array>

class QDockWidget;
class QMainWindow;

namespace haustra::window {

enum class BuiltinLayout {
    reading,      ///< as dissertation §6.3.2 arranges them (figure 6.4)
    slicesFirst,  ///< 2-D reading, the endoscopic view to solve problems
    flattened,    ///< the flattened colon first
    twoMonitors,  ///< slices and overview in a window of their own, on the other monitor
};

/// The docks; they outlive this.
struct Docks {
    QDockWidget *endoscopic = nullptr, *axial = nullptr, *coronal = nullptr, *sagittal = nullptr,
                *strip = nullptr, *zoom = nullptr, *overview = nullptr, *oblique = nullptr,
                *bookmarks = nullptr, *findings = nullptr, *missed = nullptr, *optics = nullptr;
    std::array<QDockWidget*, 12> all() const {
        return {endoscopic, axial,   coronal,   sagittal, strip,  zoom,
                overview,   oblique, bookmarks, findings, missed, optics};
    }
    bool isFlat(const QDockWidget* dock) const { return dock == strip || dock == zoom; }
};

/// Belongs to the main thread. `second` is the window for the other monitor.
class Layouts {
public:
    Layouts(QMainWindow& main, QMainWindow& second, Docks docks)
        : main_(main), second_(second), docks_(docks) {}

    /// `flat`: the case has been flattened; else its two panes are hidden, whatever the layout.
    void arrange(BuiltinLayout layout, bool flat);
    /// Before docks are hidden or arranged: ends the drag of one, or of an edge between them, for
    /// which Qt keeps the former arrangement, with pointers to what is gone then.
    void letGo();
    /// The arrangement as it is, with sizes.
    QByteArray state() const;
    /// False where it is none.
    bool restore(const QByteArray& state, bool flat);

    /// Those that the reader has saved by name, in the settings.
    static QStringList names();
    void save(const QString& name) const;
    bool restore(const QString& name, bool flat);
    static void remove(const QString& name);

private:
    void gather();
    void floatOptics();
    void showFlat(bool flat);
    void fillSecond();
    void placeLists();

    QMainWindow &main_, &second_;
    Docks docks_;
};

}  // namespace haustra::window
