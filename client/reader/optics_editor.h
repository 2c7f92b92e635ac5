// The optics by which a reader sees the wall: the server's presets, and what a hand makes of them.
#pragma once

#include "core/optics_preset.h"
#include "reader/case_info.h"
#include "reader/transfer_curve.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace haustra::reader {

/// One preset is chosen, and shown as it has been changed since; each keeps its changes while
/// others are looked at. Whatever is called, optics() passes checkOptics.
class OpticsEditor {
public:
    /// Until a server offers some, a preset that shows nothing.
    OpticsEditor();
    /// The server's, sound, the default first: chosen. What was changed or opened before is
    /// forgotten.
    void offer(std::vector<OpticsPreset> presets);

    std::size_t presets() const { return drafts_.size(); }
    const OpticsPreset& preset(std::size_t n) const { return drafts_[n].preset; }
    bool isChanged(std::size_t n) const;
    std::size_t chosen() const { return chosen_; }
    void choose(std::size_t n);
    /// False where there is none of that name.
    bool choose(const std::string& name);
    /// As the server or the file has it.
    void backToPreset();

    /// What is shown, and how to tell the server.
    const Optics& optics() const { return draft().optics; }
    OpticsChoice choice() const;
    /// Grows whenever what is shown may have become another.
    std::uint64_t revision() const { return revision_; }

    /// All that is shown, to be shown again: which preset, as it has been changed.
    struct ShownOptics {
        std::string preset;
        Optics optics;
        std::size_t row = 0;
    };
    ShownOptics shown() const { return {preset(chosen_).name, optics(), row_}; }
    /// Nothing where there is no such preset any more.
    void show(const ShownOptics& shown);

    void setComposition(Composition composition);
    /// Not of a transfer function with gradient rows: stays off.
    void setPreIntegrated(bool preIntegrated);
    void setShading(bool shading);
    /// Brought into checkOptics' bounds.
    void setLight(Headlight light);

    /// Rows by gradient magnitude: 0 is the transfer function's own points, at magnitude 0; those
    /// after it make it a 2-D one. One of them is being edited.
    std::size_t rows() const { return optics().transferFunction.rows.size() + 1; }
    std::size_t row() const { return row_; }
    void chooseRow(std::size_t row);
    double gradientOf(std::size_t row) const;
    /// No farther than to the neighbours' magnitudes; row 0 stays at 0.
    void setGradient(std::size_t row, double huPerMm);
    /// After the row being edited, of its points, and edited from now on. Turns pre-integration
    /// off. False where there is no room.
    bool addRow();
    /// The row being edited; false of row 0.
    bool removeRow();

    /// The points of the row being edited. Setting them does nothing where all rows together would
    /// have more than mostTransferPointsInAll.
    TransferCurve curve() const;
    void setCurve(const TransferCurve& curve);

    /// Writes what is shown to a preset's file, named by its stem; replaced in one step. Then that
    /// preset is among the others, and chosen. Fails (badInput) where the name is none of a preset
    /// or does not end in .json, (io) where it cannot be written.
    Result<void> save(const std::filesystem::path& file);
    /// Reads a preset's file, and chooses it. Fails as readPresetFile does.
    Result<void> open(const std::filesystem::path& file);

private:
    struct Draft {
        OpticsPreset preset;
        Optics optics;       ///< as changed
        bool served = true;  ///< the server knows it by its name
    };
    explicit OpticsEditor(std::uint64_t revision) : OpticsEditor() { revision_ = revision; }
    const Draft& draft() const { return drafts_[chosen_]; }
    Optics& change();
    void take(OpticsPreset preset);

    std::vector<Draft> drafts_;  // never empty
    std::size_t chosen_ = 0, row_ = 0;
    std::uint64_t revision_ = 0;
};

}  // namespace haustra::reader
