#include "flatten/general/period_matrix.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <Eigen/LU>

namespace haustra::flatten {
namespace {

using IntegerRows = std::vector<std::vector<int>>;

/// Integer combinations of forms (rows) whose wedge products are those of canonical loops' duals:
/// row i with row g + i gives 1, all others 0. Gram and Schmidt's way over the integers.
class CanonicalForms {
public:
    explicit CanonicalForms(const IntegerRows& wedge) : wedge_(wedge) {
        for (std::size_t i = 0; i < wedge.size(); ++i) {
            left_.emplace_back(wedge.size(), 0);
            left_.back()[i] = 1;
        }
    }

    IntegerRows find() {
        IntegerRows a, b;
        while (!left_.empty()) {
            takePair();
            a.push_back(first_);
            b.push_back(second_);
        }
        a.insert(a.end(), b.begin(), b.end());
        return a;
    }

private:
    int product(const std::vector<int>& x, const std::vector<int>& y) const {
        int sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (std::size_t j = 0; j < y.size(); ++j)
                sum += x[i] * wedge_[i][j] * y[j];
        }
        return sum;
    }

    static void add(std::vector<int>& to, int times, const std::vector<int>& what) {
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] += times * what[i];
    }

    /// Takes the two rows of the smallest product that is not 0, and makes the others orthogonal
    /// to them. A remainder is smaller yet, and is taken instead.
    void takePair() {
        for (;;) {
            std::size_t i = 0, j = 0;
            int least = 0;
            for (std::size_t p = 0; p < left_.size(); ++p) {
                for (std::size_t q = p + 1; q < left_.size(); ++q) {
                    const int value = product(left_[p], left_[q]);
                    if (value == 0 || (least != 0 && std::abs(value) >= std::abs(least))) continue;
                    least = value;
                    i = p;
                    j = q;
                }
            }
            if (least < 0) std::swap(i, j);
            least = std::abs(least);
            first_ = left_[i];
            second_ = left_[j];
            bool whole = true;
            for (std::size_t k = 0; k < left_.size(); ++k) {
                if (k == i || k == j) continue;
                const int withFirst = product(left_[k], first_),
                          withSecond = product(left_[k], second_);
                add(left_[k], -(withSecond / least), first_);
                add(left_[k], withFirst / least, second_);
                whole = whole && withFirst % least == 0 && withSecond % least == 0;
            }
            if (!whole) continue;
            left_.erase(left_.begin() + std::ptrdiff_t(std::max(i, j)));
            left_.erase(left_.begin() + std::ptrdiff_t(std::min(i, j)));
            return;
        }
    }

    const IntegerRows& wedge_;
    IntegerRows left_;
    std::vector<int> first_, second_;
};

}  // namespace

PeriodMatrix periodMatrix(const HolomorphicBasis& basis) {
    const auto size = Eigen::Index(basis.harmonic.size()), genus = size / 2;
    const IntegerRows canonical = CanonicalForms(basis.wedge).find();
    Eigen::MatrixXd forms(size, size), star(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        for (Eigen::Index j = 0; j < size; ++j) {
            forms(i, j) = canonical[std::size_t(i)][std::size_t(j)];
            star(i, j) = basis.star[std::size_t(i)][std::size_t(j)];
        }
    }
    const Eigen::MatrixXd inverse = forms.inverse();
    // Canonical form k + i·its conjugate has period δ_ik + i·star_ki over canonical loop i.
    const Eigen::MatrixXd canonicalStar = forms * star * inverse;
    const Eigen::MatrixXcd periods =
        (Eigen::MatrixXcd::Identity(size, size) +
         std::complex<double>(0.0, 1.0) * canonicalStar.transpose().cast<std::complex<double>>())
            .leftCols(genus);
    const Eigen::MatrixXcd toUnit = periods.topRows(genus).inverse();
    const Eigen::MatrixXcd values = periods.bottomRows(genus) * toUnit;
    const Eigen::MatrixXcd coefficients =
        forms.topRows(genus).transpose().cast<std::complex<double>>() * toUnit;

    PeriodMatrix made;
    made.values.assign(std::size_t(genus), std::vector<std::complex<double>>(std::size_t(genus)));
    made.forms.assign(std::size_t(genus), std::vector<std::complex<double>>(std::size_t(size)));
    made.loops.assign(std::size_t(size), std::vector<int>(std::size_t(size)));
    for (Eigen::Index i = 0; i < genus; ++i) {
        for (Eigen::Index j = 0; j < genus; ++j)
            made.values[std::size_t(i)][std::size_t(j)] = values(i, j);
        for (Eigen::Index k = 0; k < size; ++k)
            made.forms[std::size_t(i)][std::size_t(k)] = coefficients(k, i);
    }
    // Loops that the canonical forms are dual to: the inverse's transpose.
    for (Eigen::Index i = 0; i < size; ++i) {
        for (Eigen::Index k = 0; k < size; ++k)
            made.loops[std::size_t(i)][std::size_t(k)] = int(std::lround(inverse(k, i)));
    }
    return made;
}

}  // namespace haustra::flatten
