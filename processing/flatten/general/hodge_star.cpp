#include "flatten/general/hodge_star.h"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

namespace haustra::flatten {
namespace {

Eigen::MatrixXd toEigen(const Matrix& matrix) {
    const auto size = Eigen::Index(matrix.size());
    Eigen::MatrixXd made(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        for (Eigen::Index j = 0; j < size; ++j)
            made(i, j) = matrix[std::size_t(i)][std::size_t(j)];
    }
    return made;
}

}  // namespace

HodgeStar hodgeStar(const Matrix& product, const Matrix& wedge) {
    const Eigen::LLT<Eigen::MatrixXd> cholesky(toEigen(product));
    const Eigen::MatrixXd lower = cholesky.matrixL();
    const auto triangle = lower.triangularView<Eigen::Lower>();
    // In an orthonormal basis of the forms: skew, and a rotation but for the lengths σ.
    const Eigen::MatrixXd half = triangle.solve(toEigen(wedge));
    const Eigen::MatrixXd skew = triangle.solve(half.transpose()).transpose();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(skew, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::MatrixXd rotation = svd.matrixU() * svd.matrixV().transpose();
    const Eigen::MatrixXd inverse =
        triangle.solve(Eigen::MatrixXd::Identity(lower.rows(), lower.cols()));
    const Eigen::MatrixXd star = lower * rotation * inverse;

    HodgeStar made;
    made.star.assign(product.size(), std::vector<double>(product.size()));
    for (std::size_t i = 0; i < product.size(); ++i) {
        for (std::size_t j = 0; j < product.size(); ++j)
            made.star[i][j] = star(Eigen::Index(i), Eigen::Index(j));
    }
    const double least = svd.singularValues().minCoeff();
    made.certificate = std::max(0.0, 1.0 / (least * least) - 1.0);
    return made;
}

}  // namespace haustra::flatten
