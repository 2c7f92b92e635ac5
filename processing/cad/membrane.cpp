#include "cad/membrane.h"

#include <cstddef>
#include <optional>

#include <Eigen/SparseCholesky>

namespace haustra::cad {
namespace {

// What is left of the residual's square.
constexpr float enoughLeft = 1e-6f, leastLeft = 1e-12f;
constexpr int mostSteps = 500;
// So many samples move as one.
constexpr std::size_t aggregateSamples = 16;

glm::vec4 quotientOf(const glm::vec4& a, const glm::vec4& b) {
    glm::vec4 quotient(0.0f);
    for (int c = 0; c < 3; ++c)
        if (b[c] > 0.0f) quotient[c] = a[c] / b[c];
    return quotient;
}

}  // namespace

// Z (ZᵀAZ)⁻¹ Zᵀ.
class Membrane::Coarse {
public:
    explicit Coarse(const Membrane& fine) : aggregateOf_(fine.pull_.size(), none) {
        const std::size_t count = aggregateOf_.size();
        // Breadth first from each sample that is in none yet.
        std::vector<std::uint32_t> aggregate;
        for (std::uint32_t first = 0; first < count; ++first) {
            if (aggregateOf_[first] != none) continue;
            aggregate.assign(1, first);
            aggregateOf_[first] = aggregates_;
            for (std::size_t head = 0;
                 head < aggregate.size() && aggregate.size() < aggregateSamples; ++head) {
                const std::uint32_t n = aggregate[head];
                for (std::uint32_t l = fine.begin_[n]; l < fine.begin_[n + 1]; ++l) {
                    const std::uint32_t next = fine.links_[l];
                    if (next == count || aggregateOf_[next] != none) continue;
                    aggregateOf_[next] = aggregates_;
                    aggregate.push_back(next);
                }
            }
            ++aggregates_;
        }
        std::vector<double> diagonal(aggregates_, 0.0);
        std::vector<Eigen::Triplet<double>> entries;
        for (std::uint32_t n = 0; n < count; ++n) {
            const std::uint32_t own = aggregateOf_[n];
            diagonal[own] += double(fine.degrees_[n]);
            for (std::uint32_t l = fine.begin_[n]; l < fine.begin_[n + 1]; ++l) {
                const std::uint32_t next = fine.links_[l];
                if (next == count) continue;
                if (aggregateOf_[next] == own)
                    diagonal[own] -= 1.0;
                else if (aggregateOf_[next] < own)  // the lower triangle is enough
                    entries.emplace_back(int(own), int(aggregateOf_[next]), -1.0);
            }
        }
        // A hair more, so that there is a factor even if, against the precondition, no rim holds
        // it.
        for (std::uint32_t each = 0; each < aggregates_; ++each)
            entries.emplace_back(int(each), int(each), (1.0 + 1e-6) * diagonal[each] + 1e-6);
        Eigen::SparseMatrix<double> a(aggregates_, aggregates_);
        a.setFromTriplets(entries.begin(), entries.end());
        factor_.compute(a);
        all_.resize(aggregates_, 3);
    }

    // z = M⁻¹ r; returns r · z of each coordinate.
    glm::vec4 precondition(const Field& r, const std::vector<float>& degrees, Field& z) {
        all_.setZero();
        for (std::size_t n = 0; n < r.size(); ++n)
            for (int c = 0; c < 3; ++c)
                all_(aggregateOf_[n], c) += double(r[n][c]);
        const Eigen::Matrix<double, Eigen::Dynamic, 3> solved = factor_.solve(all_);
        moves_.resize(aggregates_);
        for (std::uint32_t each = 0; each < aggregates_; ++each)
            moves_[each] = glm::vec4(solved(each, 0), solved(each, 1), solved(each, 2), 0.0);
        glm::dvec4 dot(0.0);
        for (std::size_t n = 0; n < r.size(); ++n) {
            z[n] = r[n] / degrees[n] + moves_[aggregateOf_[n]];
            dot += glm::dvec4(r[n] * z[n]);
        }
        return glm::vec4(dot);
    }

private:
    static constexpr std::uint32_t none = ~0u;
    std::vector<std::uint32_t> aggregateOf_;
    std::uint32_t aggregates_ = 0;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
    Eigen::Matrix<double, Eigen::Dynamic, 3> all_;
    Field moves_;
};

Membrane::Membrane(const WallSamples& wall, const SampleNumbers& inside)
    : origin_(wall.mesh.vertices[inside.sample(0)]) {
    const std::uint32_t count = inside.count();
    begin_.reserve(count + 1);
    begin_.push_back(0);
    places_.reserve(count), pull_.reserve(count), degrees_.reserve(count);
    const auto placeOf = [&](std::uint32_t v) {
        return glm::vec4(wall.mesh.vertices[v] - origin_, 0.0);
    };
    for (std::uint32_t n = 0; n < count; ++n) {
        const std::uint32_t v = inside.sample(n);
        glm::vec4 pull(0.0f);
        for (const std::uint32_t next : wall.around(v)) {
            if (inside.has(next))
                links_.push_back(inside.number(next));
            else
                pull += placeOf(next);
        }
        // Rows are filled up to whole fours with links to a zero: most are as long, and where a
        // loop over one ends is predicted.
        while (links_.size() % 4 != 0)
            links_.push_back(count);
        begin_.push_back(std::uint32_t(links_.size()));
        places_.push_back(placeOf(v));
        pull_.push_back(pull);
        degrees_.push_back(float(wall.around(v).size()));
    }
    places_.push_back(glm::vec4(0.0f));
    std::optional<Coarse> coarse;
    if (count >= largeFilm) coarse.emplace(*this);
    span(coarse ? &*coarse : nullptr);
}

// product = A · field; returns field · product of each coordinate. The field has a zero more, to
// which the links that fill rows up lead.
glm::vec4 Membrane::times(const Field& field, Field& product) const {
    const glm::vec4* const x = field.data();
    const std::uint32_t* const links = links_.data();
    glm::dvec4 dot(0.0);
    for (std::size_t n = 0; n < product.size(); ++n) {
        glm::vec4 sum = degrees_[n] * x[n];
        for (std::uint32_t l = begin_[n]; l < begin_[n + 1]; l += 4) {
            sum -= x[links[l]];
            sum -= x[links[l + 1]];
            sum -= x[links[l + 2]];
            sum -= x[links[l + 3]];
        }
        product[n] = sum;
        dot += glm::dvec4(x[n] * sum);
    }
    return glm::vec4(dot);
}

// The three coordinates are three systems with one matrix.
void Membrane::span(Coarse* coarse) {
    Field r(pull_.size()), ap(pull_.size()), preconditioned(coarse ? pull_.size() : 0);
    const Field& z = coarse ? preconditioned : r;
    times(places_, r);
    glm::dvec4 sum(0.0);
    for (std::size_t n = 0; n < r.size(); ++n) {
        r[n] = pull_[n] - r[n];
        sum += glm::dvec4(r[n] * r[n]);
    }
    glm::vec4 squares(sum);
    const glm::vec4 enough = enoughLeft * squares + glm::vec4(leastLeft);
    glm::vec4 rz = coarse ? coarse->precondition(r, degrees_, preconditioned) : squares;
    Field p = z;
    p.push_back(glm::vec4(0.0f));
    for (; steps_ < mostSteps; ++steps_) {
        if (glm::all(glm::lessThanEqual(squares, enough))) break;
        const glm::vec4 alpha = quotientOf(rz, times(p, ap));
        sum = glm::dvec4(0.0);
        for (std::size_t n = 0; n < r.size(); ++n) {
            places_[n] += alpha * p[n];
            r[n] -= alpha * ap[n];
            sum += glm::dvec4(r[n] * r[n]);
        }
        squares = glm::vec4(sum);
        const glm::vec4 next = coarse ? coarse->precondition(r, degrees_, preconditioned) : squares;
        const glm::vec4 beta = quotientOf(next, rz);
        for (std::size_t n = 0; n < r.size(); ++n)
            p[n] = z[n] + beta * p[n];
        rz = next;
    }
}

}  // namespace haustra::cad
