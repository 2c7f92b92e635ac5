// The colon surface of a case in a store: contouring and simplification at several bounds, beside
// VTK's flying edges and decimation to as many triangles, as a Markdown table. `--help` tells the
// options.
#include "contouring/dual_contouring.h"
#include "handles/self_intersection.h"
#include "simplification/simplification.h"
#include "stopwatch.h"
#include "store/case_store.h"
#include "surface_measure.h"

#include <cstdlib>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#ifdef HAUSTRA_BENCH_VTK
#include <vtkCellArray.h>
#include <vtkDecimatePro.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>
#include <vtkShortArray.h>
#include <vtkSmartPointer.h>
#endif

using namespace haustra;

namespace {

struct Input {
    Volume<std::int16_t> hu;
    Volume<std::uint8_t> lumen;
    double isoHu;
    double spacingMm;  ///< of the samples that distances are measured at
    int threads;
};

struct Timed {
    TriMesh mesh;
    double seconds;
};

template <class Work>
double secondsOf(const Work& work) {
    const double start = bench::milliseconds();
    work();
    return 1e-3 * (bench::milliseconds() - start);
}

/// What a reader wants to know of one surface, and its distance from `fine` where that is given.
void printRow(const std::string& name, const Timed& made, const TriMesh* fine, double spacingMm) {
    const TriMesh& mesh = made.mesh;
    const MeshTopology topology = meshTopology(mesh);
    const auto angles = tests::sortedSmallestAngles(mesh);
    const auto sharp = std::lower_bound(angles.begin(), angles.end(), 15.0) - angles.begin();
    const std::size_t cuts = handles::selfIntersections(mesh).size();
    std::string distances = "- | - | -";
    if (fine) {
        const auto forth = tests::sortedDistances(tests::samplesOn(mesh, spacingMm),
                                                  tests::SurfaceDistance(*fine));
        const auto back = tests::sortedDistances(tests::samplesOn(*fine, spacingMm),
                                                 tests::SurfaceDistance(mesh));
        double sum = 0.0;
        for (const double d : back)
            sum += d;
        const auto p95 = [](const std::vector<double>& d) { return d[d.size() * 95 / 100]; };
        distances =
            fmt::format("{:.4f} | {:.3f} | {:.3f}", sum / double(back.size()),
                        std::max(p95(forth), p95(back)), std::max(forth.back(), back.back()));
    }
    fmt::print("| {} | {:.2f} | {} | {} | {} | {} | {} | {:.2f} | {:.1f} | {:.2f} | {} |\n", name,
               made.seconds, mesh.triangles.size(), topology.eulerCharacteristic,
               topology.components, topology.nonManifoldEdges + topology.boundaryEdges, cuts,
               angles.front(), angles[angles.size() / 100],
               100.0 * double(sharp) / double(angles.size()), distances);
    std::fflush(stdout);
}

#ifdef HAUSTRA_BENCH_VTK

TriMesh fromVtk(vtkPolyData& data, const glm::dmat4& patientFromPoint) {
    TriMesh mesh;
    for (vtkIdType v = 0; v < data.GetNumberOfPoints(); ++v) {
        double p[3];
        data.GetPoint(v, p);
        mesh.vertices.push_back(glm::dvec3(patientFromPoint * glm::dvec4(p[0], p[1], p[2], 1.0)));
    }
    vtkCellArray& cells = *data.GetPolys();
    const auto corners = vtkSmartPointer<vtkIdList>::New();
    for (cells.InitTraversal(); cells.GetNextCell(corners);) {
        if (corners->GetNumberOfIds() != 3) continue;
        mesh.triangles.push_back(
            {int(corners->GetId(0)), int(corners->GetId(1)), int(corners->GetId(2))});
    }
    return mesh;
}

/// The volume in which the level isoHu parts the lumen's voxels from all others.
vtkSmartPointer<vtkImageData> restrictedImage(const Input& input) {
    const auto image = vtkSmartPointer<vtkImageData>::New();
    const glm::ivec3 size = input.hu.grid().size;
    image->SetDimensions(size.x, size.y, size.z);
    image->AllocateScalars(VTK_SHORT, 1);
    auto* voxels = static_cast<short*>(image->GetScalarPointer());
    const auto hu = input.hu.voxels();
    const auto lumen = input.lumen.voxels();
    const double iso = input.isoHu;
    for (std::size_t n = 0; n < hu.size(); ++n) {
        voxels[n] = short(lumen[n] != 0 ? std::min(double(hu[n]), std::floor(iso - 1.0))
                                        : std::max(double(hu[n]), std::ceil(iso + 1.0)));
    }
    return image;
}

class VtkRows {
public:
    explicit VtkRows(const Input& input) : input_(input), edges_(Edges::New()) {
        const auto image = restrictedImage(input);
        edges_->SetInputData(image);
        edges_->SetValue(0, input.isoHu);
        edges_->ComputeNormalsOff();
        edges_->ComputeGradientsOff();
        edges_->ComputeScalarsOff();
        const double seconds = secondsOf([&] { edges_->Update(); });
        // Decimation must judge lengths in millimetres, so the points are moved before it.
        auto& points = *edges_->GetOutput()->GetPoints();
        for (vtkIdType v = 0; v < points.GetNumberOfPoints(); ++v) {
            double p[3];
            points.GetPoint(v, p);
            const glm::dvec4 moved =
                input.hu.grid().patientFromVoxel * glm::dvec4(p[0], p[1], p[2], 1.0);
            points.SetPoint(v, moved.x, moved.y, moved.z);
        }
        fine_ = fromVtk(*edges_->GetOutput(), glm::dmat4(1.0));
        printRow("VTK flying edges", {fine_, seconds}, nullptr, input.spacingMm);
    }

    void decimateTo(std::size_t triangles) const {
        const double reduction = 1.0 - double(triangles) / double(fine_.triangles.size());
        const auto quadric = vtkSmartPointer<vtkQuadricDecimation>::New();
        quadric->SetTargetReduction(reduction);
        print("VTK quadric decimation", *quadric);
        const auto pro = vtkSmartPointer<vtkDecimatePro>::New();
        pro->SetTargetReduction(reduction);
        pro->PreserveTopologyOn();
        pro->SplittingOff();
        print("VTK DecimatePro, topology kept", *pro);
    }

private:
    using Edges = vtkSmartPointer<vtkFlyingEdges3D>;

    template <class Filter>
    void print(const char* name, Filter& filter) const {
        filter.SetInputData(edges_->GetOutput());
        const double seconds = secondsOf([&] { filter.Update(); });
        printRow(name, {fromVtk(*filter.GetOutput(), glm::dmat4(1.0)), seconds}, &fine_,
                 input_.spacingMm);
    }

    const Input& input_;
    Edges edges_;
    TriMesh fine_;
};

#endif

int run(const Input& input, const std::vector<double>& boundsMm) {
    fmt::print(
        "| surface | s | triangles | χ | parts | bad edges | self-intersections | least angle ° | "
        "1 % angle ° | under 15° % | mean mm | 95 % mm | Hausdorff mm |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    TriMesh fine;
    const double seconds = secondsOf([&] {
        auto made = contouring::contourLumen(input.hu, input.lumen, input.isoHu, {input.threads});
        if (made) fine = std::move(*made);
    });
    if (fine.triangles.empty()) {
        fmt::print(stderr, "the lumen gives no surface\n");
        return EXIT_FAILURE;
    }
    const Timed whole{std::move(fine), seconds};
    printRow("dual contouring", whole, nullptr, input.spacingMm);
    std::vector<std::size_t> counts;
    for (const double errorMm : boundsMm) {
        simplification::SimplificationOptions options;
        options.errorMm = errorMm;
        options.threads = input.threads;
        Timed simple{};
        simple.seconds = secondsOf([&] {
            if (auto made = simplification::simplify(whole.mesh, options))
                simple.mesh = std::move(*made);
        });
        if (simple.mesh.triangles.empty()) {
            fmt::print(stderr, "the surface cannot be simplified\n");
            return EXIT_FAILURE;
        }
        counts.push_back(simple.mesh.triangles.size());
        printRow(fmt::format("simplified, {} mm", errorMm), simple, &whole.mesh, input.spacingMm);
    }
#ifdef HAUSTRA_BENCH_VTK
    const VtkRows vtk(input);
    for (const std::size_t count : counts)
        vtk.decimateTo(count);
#endif
    return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Surfaces of a case: time, shape and distance from the finest");
    std::string storeFolder, caseName, huProduct, lumenProduct = "lumen";
    std::vector<double> boundsMm{0.05, 0.1, 0.2};
    double isoHu = -400.0, spacingMm = 0.4;
    int threads = 0;
    app.add_option("case", caseName, "the case's name")->required();
    app.add_option("--store", storeFolder, "the store's folder")->required();
    app.add_option("--hu", huProduct, "the volume that is contoured (default: cleansed, else ct)");
    app.add_option("--lumen", lumenProduct, "the labels that restrict it")->capture_default_str();
    app.add_option("--iso-hu", isoHu, "HU of the wall")->capture_default_str();
    app.add_option("--bounds-mm", boundsMm, "bounds of the simplification")->capture_default_str();
    app.add_option("--spacing-mm", spacingMm, "of the samples for distances")
        ->capture_default_str();
    app.add_option("--threads", threads, "0: all cores")->capture_default_str();
    CLI11_PARSE(app, argc, argv);

    const auto opened = store::CaseStore::open(storeFolder, false).and_then([&](const auto& store) {
        return store.openCase(caseName);
    });
    if (!opened) {
        fmt::print(stderr, "{}\n", describe(opened.error()));
        return EXIT_FAILURE;
    }
    if (huProduct.empty()) huProduct = opened->find("cleansed") ? "cleansed" : "ct";
    auto hu = opened->readVolume<std::int16_t>(huProduct);
    auto lumen = opened->readVolume<std::uint8_t>(lumenProduct);
    if (!hu || !lumen) {
        fmt::print(stderr, "{}\n", describe(!hu ? hu.error() : lumen.error()));
        return EXIT_FAILURE;
    }
    return run({std::move(*hu), std::move(*lumen), isoHu, spacingMm, threads}, boundsMm);
}
