#include "core/quantile.h"
#include "coverage/calibration_libraries.h"
#include "coverage/lens_projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <glog/logging.h>

namespace haustra::coverage::module {
namespace {

using Numbers = std::array<double, lensNumbers>;
using Pose = std::array<double, 6>;        // angle-axis, and the board's origin, mm
using Homography = std::array<double, 9>;  // row by row, to a direction, of unit norm
constexpr std::size_t muAt = 5;

FisheyeLens lensOf(Projection projection, const Numbers& n) {
    return {{n[0], n[1], n[2], n[3], n[4]}, n[5], n[6], n[7], n[8], projection, {n[9], n[10]}};
}

template <class T>
bool show(Projection projection, const T* numbers, const T& x, const T& y, const T& z, T* pixel) {
    if (projection == Projection::perspective && !(z > T(0.0))) return false;
    projectTo(projection, numbers, numbers + 5, numbers + 7, numbers + 9, x, y, z, pixel);
    return true;
}

struct ProjectionError {
    Projection projection;
    glm::dvec2 placeMm, pixel;

    template <class T>
    bool operator()(const T* numbers, const T* pose, T* error) const {
        const T place[3] = {T(placeMm.x), T(placeMm.y), T(0.0)};
        T at[3], shown[2];
        ceres::AngleAxisRotatePoint(pose, place, at);
        for (int axis = 0; axis < 3; ++axis)
            at[axis] += pose[3 + axis];
        if (!show(projection, numbers, at[0], at[1], at[2], shown)) return false;
        error[0] = pixel.x - shown[0], error[1] = pixel.y - shown[1];
        return true;
    }
};

struct HomographyError {
    Projection projection;
    glm::dvec2 place, pixel;

    template <class T>
    bool operator()(const T* numbers, const T* h, T* error) const {
        const T x(place.x), y(place.y);
        T shown[2];
        if (!show(projection, numbers, T(h[0] * x + h[1] * y + h[2]), T(h[3] * x + h[4] * y + h[5]),
                  T(h[6] * x + h[7] * y + h[8]), shown))
            return false;
        error[0] = pixel.x - shown[0], error[1] = pixel.y - shown[1];
        return true;
    }
};

/// Zhang's two conditions: the first two columns are perpendicular and of one length.
struct RotationError {
    double weight;

    template <class T>
    bool operator()(const T* h, T* error) const {
        const T a = h[0] * h[0] + h[3] * h[3] + h[6] * h[6],
                b = h[1] * h[1] + h[4] * h[4] + h[7] * h[7],
                ab = h[0] * h[1] + h[3] * h[4] + h[6] * h[7];
        error[0] = weight * ab / ceres::sqrt(a * b);
        error[1] = weight * (a - b) / (a + b);
        return true;
    }
};

ceres::Solver::Options solverOptions() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.max_num_iterations = 400;
    options.function_tolerance = 1e-14;
    options.parameter_tolerance = 1e-12;
    options.gradient_tolerance = 1e-14;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    return options;
}

/// Cost, or none where the solver found nothing usable.
std::optional<double> solve(ceres::Problem& problem) {
    ceres::Solver::Summary summary;
    ceres::Solve(solverOptions(), &problem, &summary);
    if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost)) return std::nullopt;
    return summary.final_cost;
}

/// A board's places about their middle, in its own size: well-conditioned.
struct BoardFrame {
    glm::dvec2 middle{0.0};
    double size = 1.0;

    explicit BoardFrame(const std::vector<glm::dvec2>& places) {
        for (const glm::dvec2& p : places)
            middle += p / double(places.size());
        double squares = 0.0;
        for (const glm::dvec2& p : places)
            squares += glm::dot(p - middle, p - middle) / double(places.size());
        size = std::sqrt(squares);
    }
    glm::dvec2 operator()(glm::dvec2 place) const { return (place - middle) / size; }
};

class Calibrator {
public:
    Calibrator(std::vector<BoardView> views, const CalibrationOptions& options)
        : views_(std::move(views)), options_(options), model_(*options.model) {
        const bool known = options_.pixelsPerMm && !model_.firstIsOne;
        held_ = known ? muAt : 0;
        heldAt_ = known               ? *options_.pixelsPerMm
                  : model_.firstIsOne ? 1.0
                                      : options_.focalMm.value_or(1.0);
        if (!options_.start || model_.firstIsOne || options_.pixelsPerMm || options_.focalMm)
            return;
        held_ = muAt, heldAt_ = options_.start->mu;
    }

    Result<Calibration> run() {
        std::vector<FisheyeLens> starts;
        if (options_.start)
            starts.push_back(*options_.start);
        else
            for (const double field : fields())
                starts.push_back(nominalLens(field));
        std::optional<double> least;
        Numbers best{};
        std::vector<Homography> bestHomographies;
        for (const FisheyeLens& start : starts) {
            numbers_ = scaled(start);
            if (!linearHomographies()) continue;
            const auto cost = refineByHomographies();
            if (!cost || (least && *cost >= *least)) continue;
            least = cost, best = numbers_, bestHomographies = homographies_;
        }
        if (!least) return doesNotFit();
        numbers_ = best, homographies_ = bestHomographies;
        posesFromHomographies();
        if (!minimise(false)) return doesNotFit();
        Calibration result;
        result.startRmsPixels = rms();
        if (!minimise(true)) return doesNotFit();
        if (!views_.front().areas.empty()) TRY(correctDots(result));
        TRY(finish(result));
        return result;
    }

private:
    std::vector<double> fields() const {
        if (options_.fieldDegrees) return {*options_.fieldDegrees};
        if (model_.projection == Projection::perspective) return {50.0, 80.0, 110.0};
        if (model_.projection == Projection::orthogonal) return {60.0, 90.0, 120.0, 150.0};
        return {60.0, 90.0, 120.0, 150.0, 180.0};
    }
    static tl::unexpected<Error> doesNotFit() {
        return fail(ErrorKind::noResult, "no lens of this model fits the boards that were found");
    }

    // ---- step 1

    FisheyeLens nominalLens(double fieldDegrees) const {
        const double edge = glm::radians(0.5 * fieldDegrees);
        FieldEllipse field;
        if (options_.field) {
            field = *options_.field;
        } else {
            field.center = 0.5 * (glm::dvec2(options_.pictureSize) - 1.0);
            field.radii = glm::dvec2(0.5 * glm::length(glm::dvec2(options_.pictureSize)));
        }
        // A model of one coefficient is its own nominal projection, and so is a polynomial of tan
        // θ.
        const bool free = model_.coefficients > 1 && model_.projection == Projection::equidistance;
        FisheyeLens nominal;
        nominal.projection = free ? options_.nominal : model_.projection;
        FisheyeLens lens;
        lens.projection = model_.projection;
        if (free && nominal.projection != model_.projection) {
            // Least squares over the field.
            constexpr int samples = 64;
            Eigen::MatrixXd powers(samples, model_.coefficients);
            Eigen::VectorXd radii(samples);
            for (int n = 0; n < samples; ++n) {
                const double theta =
                    std::min(edge, 0.999 * largestAngle(nominal)) * (n + 1) / samples;
                for (int c = 0; c < model_.coefficients; ++c)
                    powers(n, c) = std::pow(theta, 2 * c + 1);
                radii(n) = radiusOf(nominal, theta);
            }
            const Eigen::VectorXd fit = powers.colPivHouseholderQr().solve(radii);
            for (int c = 0; c < model_.coefficients; ++c)
                lens.k[std::size_t(c)] = fit(c);
        }
        const double atEdge = radiusOf(nominal, std::min(edge, 0.999 * largestAngle(nominal)));
        lens.mu = field.radii.x / atEdge, lens.mv = field.radii.y / atEdge;
        lens.u0 = field.center.x, lens.v0 = field.center.y;
        return lens;
    }

    /// The same lens with the held number at what it is held at.
    Numbers scaled(const FisheyeLens& lens) const {
        Numbers n = numbersOf(lens);
        const double scale = held_ == muAt ? n[muAt] / heldAt_ : heldAt_ / n[0];
        for (std::size_t i = 0; i < 5; ++i)
            n[i] = int(i) < model_.coefficients ? n[i] * scale : 0.0;
        n[5] /= scale, n[6] /= scale;
        if (!model_.decentring) n[9] = n[10] = 0.0;
        n[held_] = heldAt_;
        return n;
    }

    /// What is not sought stays as it is.
    void addNumbers(ceres::Problem& problem) {
        problem.AddParameterBlock(numbers_.data(), int(lensNumbers));
        std::vector<int> constant{int(held_)};
        for (int n = model_.coefficients; n < 5; ++n)
            constant.push_back(n);
        if (!model_.decentring) constant.insert(constant.end(), {9, 10});
        std::sort(constant.begin(), constant.end());
        problem.SetManifold(numbers_.data(), new ceres::SubsetManifold(int(lensNumbers), constant));
    }

    // ---- step 2

    /// From each board to the rays of its pixels, by the direct linear transform.
    bool linearHomographies() {
        const FisheyeLens lens = lensOf(model_.projection, numbers_);
        homographies_.clear();
        for (const BoardView& view : views_) {
            const BoardFrame frame(view.placesMm);
            Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
            std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> pairs;
            for (std::size_t n = 0; n < view.pixels.size(); ++n) {
                const auto ray = directionOf(lens, view.pixels[n]);
                if (!ray) continue;
                const glm::dvec2 at = frame(view.placesMm[n]);
                const Eigen::Vector3d d(ray->x, ray->y, ray->z), x(at.x, at.y, 1.0);
                Eigen::Matrix3d cross;
                cross << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
                Eigen::Matrix<double, 3, 9> rows;
                for (int r = 0; r < 3; ++r)
                    for (int c = 0; c < 3; ++c)
                        rows.block<1, 3>(r, 3 * c) = cross(r, c) * x.transpose();
                normal += rows.transpose() * rows;
                pairs.emplace_back(d, x);
            }
            if (pairs.size() < 6) return false;
            const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(normal);
            if (eigen.info() != Eigen::Success) return false;
            Eigen::Matrix<double, 9, 1> h = eigen.eigenvectors().col(0);
            const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> matrix(h.data());
            double along = 0.0;
            for (const auto& [d, x] : pairs)
                along += d.dot(matrix * x);
            if (along < 0.0) h = -h;
            Homography row;
            std::copy(h.data(), h.data() + 9, row.begin());
            homographies_.push_back(row);
        }
        return true;
    }

    std::optional<double> refineByHomographies() {
        ceres::Problem problem;
        addNumbers(problem);
        for (std::size_t v = 0; v < views_.size(); ++v) {
            const BoardView& view = views_[v];
            const BoardFrame frame(view.placesMm);
            for (std::size_t n = 0; n < view.pixels.size(); ++n)
                problem.AddResidualBlock(
                    new ceres::AutoDiffCostFunction<HomographyError, 2, int(lensNumbers), 9>(
                        new HomographyError{model_.projection, frame(view.placesMm[n]),
                                            view.pixels[n]}),
                    nullptr, numbers_.data(), homographies_[v].data());
            // A column that is off by a share e of its length moves the board's points by e of the
            // board's size: as heavy as those errors of all points.
            problem.AddResidualBlock(
                new ceres::AutoDiffCostFunction<RotationError, 2, 9>(new RotationError{
                    BoardFrame(view.pixels).size * std::sqrt(double(view.pixels.size()))}),
                nullptr, homographies_[v].data());
            problem.SetManifold(homographies_[v].data(), new ceres::SphereManifold<9>());
        }
        return solve(problem);
    }

    // ---- step 3

    void posesFromHomographies() {
        poses_.clear();
        for (std::size_t v = 0; v < views_.size(); ++v) {
            const BoardFrame frame(views_[v].placesMm);
            const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> h(
                homographies_[v].data());
            const Eigen::Vector3d a = h.col(0) / frame.size, b = h.col(1) / frame.size;
            const double scale = 2.0 / (a.norm() + b.norm());
            Eigen::Matrix3d columns;
            columns << scale * a, scale * b, scale * scale * a.cross(b);
            const Eigen::JacobiSVD<Eigen::Matrix3d> svd(columns,
                                                        Eigen::ComputeFullU | Eigen::ComputeFullV);
            Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
            if (rotation.determinant() < 0.0)
                rotation = svd.matrixU() * Eigen::Vector3d(1, 1, -1).asDiagonal() *
                           svd.matrixV().transpose();
            const Eigen::Vector3d origin = scale * h.col(2) - rotation.col(0) * frame.middle.x -
                                           rotation.col(1) * frame.middle.y;
            Pose pose;
            ceres::RotationMatrixToAngleAxis(rotation.data(), pose.data());  // column by column
            std::copy(origin.data(), origin.data() + 3, pose.data() + 3);
            poses_.push_back(pose);
        }
    }

    // ---- step 4

    void addViews(ceres::Problem& problem) {
        addNumbers(problem);
        for (std::size_t v = 0; v < views_.size(); ++v)
            for (std::size_t n = 0; n < views_[v].pixels.size(); ++n)
                problem.AddResidualBlock(
                    new ceres::AutoDiffCostFunction<ProjectionError, 2, int(lensNumbers), 6>(
                        new ProjectionError{model_.projection, views_[v].placesMm[n],
                                            views_[v].pixels[n]}),
                    nullptr, numbers_.data(), poses_[v].data());
    }

    bool minimise(bool internals) {
        ceres::Problem problem;
        addViews(problem);
        if (!internals) problem.SetParameterBlockConstant(numbers_.data());
        return solve(problem).has_value();
    }

    std::vector<glm::dvec2> residualsOf(std::size_t v) const {
        std::vector<glm::dvec2> residuals;
        for (std::size_t n = 0; n < views_[v].pixels.size(); ++n) {
            const ProjectionError error{model_.projection, views_[v].placesMm[n],
                                        views_[v].pixels[n]};
            glm::dvec2 residual(0.0);
            error(numbers_.data(), poses_[v].data(), &residual.x);
            residuals.push_back(residual);
        }
        return residuals;
    }
    double squares() const {
        double sum = 0.0;
        for (std::size_t v = 0; v < views_.size(); ++v)
            for (const glm::dvec2& residual : residualsOf(v))
                sum += glm::dot(residual, residual);
        return sum;
    }
    double points() const {
        double count = 0.0;
        for (const BoardView& view : views_)
            count += double(view.pixels.size());
        return count;
    }
    double rms() const { return std::sqrt(squares() / points()); }

    /// Where a place on a board is shown.
    glm::dvec2 shown(std::size_t v, glm::dvec2 placeMm) const {
        const ProjectionError error{model_.projection, placeMm, glm::dvec2(0.0)};
        glm::dvec2 residual(0.0);
        error(numbers_.data(), poses_[v].data(), &residual.x);
        return -residual;
    }

    // ---- discs

    /// The centre of a disc's picture, as a polygon's.
    glm::dvec2 centerOfDisc(std::size_t v, glm::dvec2 placeMm, double radiusMm) const {
        constexpr int corners = 48;
        const glm::dvec2 middle = shown(v, placeMm);
        double area = 0.0;
        glm::dvec2 moment(0.0);
        const auto corner = [&](int n) {
            const double angle = 2.0 * std::numbers::pi * n / corners;
            return shown(v, placeMm + radiusMm * glm::dvec2(std::cos(angle), std::sin(angle))) -
                   middle;
        };
        glm::dvec2 from = corner(0);
        for (int n = 1; n <= corners; ++n) {
            const glm::dvec2 to = corner(n % corners);
            const double twice = from.x * to.y - from.y * to.x;
            area += 0.5 * twice;
            moment += twice / 6.0 * (from + to);
            from = to;
        }
        return middle + moment / area;
    }
    /// From how many pixels each dot covers and how large a millimetre is there.
    double dotRadiusMm() const {
        std::vector<double> radii;
        for (std::size_t v = 0; v < views_.size(); ++v) {
            const BoardView& view = views_[v];
            for (std::size_t n = 0; n < view.pixels.size(); ++n) {
                const glm::dvec2 place = view.placesMm[n];
                const double step = 1e-3 * BoardFrame(view.placesMm).size;
                const glm::dvec2 across = shown(v, place + glm::dvec2(step, 0)) - shown(v, place),
                                 down = shown(v, place + glm::dvec2(0, step)) - shown(v, place);
                const double perSquareMm =
                    std::abs(across.x * down.y - across.y * down.x) / (step * step);
                radii.push_back(std::sqrt(view.areas[n] / (std::numbers::pi * perSquareMm)));
            }
        }
        return medianOf(radii);
    }

    Result<void> correctDots(Calibration& result) {
        std::vector<std::vector<glm::dvec2>> found;
        for (const BoardView& view : views_)
            found.push_back(view.pixels);
        for (int round = 0; round < 10; ++round) {
            result.dotRadiusMm = dotRadiusMm();
            result.largestBiasPixels = 0.0;
            double moved = 0.0;
            for (std::size_t v = 0; v < views_.size(); ++v) {
                for (std::size_t n = 0; n < views_[v].pixels.size(); ++n) {
                    const glm::dvec2 place = views_[v].placesMm[n];
                    const glm::dvec2 bias =
                        centerOfDisc(v, place, result.dotRadiusMm) - shown(v, place);
                    const glm::dvec2 pixel = found[v][n] - bias;
                    result.largestBiasPixels =
                        std::max(result.largestBiasPixels, glm::length(bias));
                    moved = std::max(moved, glm::distance(pixel, views_[v].pixels[n]));
                    views_[v].pixels[n] = pixel;
                }
            }
            if (!minimise(true)) return doesNotFit();
            if (moved < 1e-4) break;
        }
        return {};
    }

    // ---- what is told

    Result<void> finish(Calibration& result) {
        result.lens = lensOf(model_.projection, numbers_);
        result.held = held_;
        result.rmsPixels = rms();
        for (std::size_t v = 0; v < views_.size(); ++v) {
            ViewFit fit;
            double rotation[9];
            ceres::AngleAxisToRotationMatrix(poses_[v].data(), rotation);
            for (int n = 0; n < 9; ++n)
                fit.cameraFromBoard[n / 3][n % 3] = rotation[n];
            fit.originMm = {poses_[v][3], poses_[v][4], poses_[v][5]};
            fit.residuals = residualsOf(v);
            double sum = 0.0;
            for (const glm::dvec2& residual : fit.residuals) {
                sum += glm::dot(residual, residual);
                fit.largestPixels = std::max(fit.largestPixels, glm::length(residual));
            }
            fit.rmsPixels = std::sqrt(sum / double(fit.residuals.size()));
            for (const glm::dvec2& place : views_[v].placesMm) {
                const glm::dvec3 at = fit.cameraFromBoard * glm::dvec3(place, 0.0) + fit.originMm;
                result.largestAngle =
                    std::max(result.largestAngle, std::atan2(std::hypot(at.x, at.y), at.z));
            }
            result.views.push_back(std::move(fit));
        }
        if (!checkLens(result.lens) || largestAngle(result.lens) < result.largestAngle)
            return fail(ErrorKind::noResult,
                        "the lens that fits best does not grow out to the outermost point: a model "
                        "of fewer coefficients, or points nearer to the edge, are needed");
        return findErrors(result);
    }

    Result<void> findErrors(Calibration& result) {
        ceres::Problem problem;
        addViews(problem);
        ceres::Covariance::Options options;
        options.algorithm_type = ceres::DENSE_SVD;
        options.min_reciprocal_condition_number = 1e-17;
        options.num_threads = 1;
        ceres::Covariance covariance(options);
        const double* block = numbers_.data();
        const std::vector<std::pair<const double*, const double*>> blocks{{block, block}};
        std::array<double, lensNumbers * lensNumbers> squares{};
        const double sought = double(model_.coefficients + 4 + (model_.decentring ? 2 : 0) - 1) +
                              6.0 * double(views_.size());
        const double freedom = 2.0 * points() - sought;
        if (freedom < 1.0 || !covariance.Compute(blocks, &problem) ||
            !covariance.GetCovarianceBlock(block, block, squares.data()))
            return fail(ErrorKind::noResult,
                        "the pictures do not determine the lens: boards that are tilted "
                        "differently, and out to the edge, are needed");
        const double perPixel = this->squares() / freedom;
        const auto at = [&](std::size_t i, std::size_t j) {
            return perPixel * squares[lensNumbers * i + j];
        };
        for (std::size_t n = 0; n < lensNumbers; ++n)
            result.standardErrors[n] = std::sqrt(std::max(0.0, at(n, n)));
        const double k = numbers_[0], m = numbers_[muAt];
        result.focalPixels = k * m;
        result.focalError = std::sqrt(
            std::max(0.0, m * m * at(0, 0) + 2.0 * k * m * at(0, muAt) + k * k * at(muAt, muAt)));
        return {};
    }

    std::vector<BoardView> views_;
    const CalibrationOptions& options_;
    const LensModel& model_;
    std::size_t held_ = 0;
    double heldAt_ = 1.0;
    Numbers numbers_{};
    std::vector<Homography> homographies_;
    std::vector<Pose> poses_;
};

}  // namespace

Result<Calibration> calibrate(const std::vector<BoardView>& views,
                              const CalibrationOptions& options) try {
    const auto wrong = [](const char* what) { return fail(ErrorKind::badInput, what); };
    // What Ceres refuses is told in one sentence, here: not on stderr too.
    FLAGS_minloglevel = google::GLOG_FATAL;
    if (!options.model) return wrong("a calibration needs a lens model");
    if (views.empty()) return wrong("a calibration needs a picture of a board");
    for (const BoardView& view : views) {
        const std::size_t count = view.pixels.size();
        if (count < 6 || view.placesMm.size() != count ||
            (view.areas.size() != count && !view.areas.empty()) ||
            view.areas.empty() != views.front().areas.empty())
            return wrong("a view of a board needs six points, each with its place");
    }
    if (options.start && options.start->projection != options.model->projection)
        return wrong("the lens to begin with is of another projection than the model");
    if (options.fieldDegrees && !(*options.fieldDegrees >= LensModel::leastFieldDegrees &&
                                  *options.fieldDegrees <= options.model->mostFieldDegrees()))
        return wrong("the nominal field of view is more than this lens model shows");
    for (const auto& length : {options.pixelsPerMm, options.focalMm})
        if (length && !(*length > 0.0 && std::isfinite(*length)))
            return wrong("nominal lengths must be over 0");
    return Calibrator(views, options).run();
} catch (const std::exception&) {
    return fail(ErrorKind::noResult, "the calibration's solver fails on these points");
}

}  // namespace haustra::coverage::module
