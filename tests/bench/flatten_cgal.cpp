#include "flatten_cgal.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Discrete_conformal_map_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Square_border_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>

namespace haustra::bench {
namespace {

namespace parameterization = CGAL::Surface_mesh_parameterization;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Mesh::Vertex_index;
using Square = parameterization::Square_border_arc_length_parameterizer_3<Mesh>;

template <class Parameterizer>
DiscMap mapWith(Mesh& mesh, Parameterizer parameterizer) {
    const auto border = CGAL::Polygon_mesh_processing::longest_border(mesh).first;
    auto flat = mesh.add_property_map<Vertex, Kernel::Point_2>("v:flat").first;
    const auto outcome = parameterization::parameterize(mesh, parameterizer, border, flat);
    DiscMap made;
    if (outcome != parameterization::OK)
        made.failure = parameterization::get_error_message(outcome);
    for (const Vertex v : mesh.vertices())
        made.flat.emplace_back(flat[v].x(), flat[v].y());
    return made;
}

}  // namespace

DiscMap cgalMap(const TriMesh& disc, CgalMethod method, const int corners[4]) {
    Mesh mesh;
    for (const glm::dvec3& at : disc.vertices)
        mesh.add_vertex({at.x, at.y, at.z});
    for (const glm::ivec3& t : disc.triangles)
        mesh.add_face(Vertex(unsigned(t.x)), Vertex(unsigned(t.y)), Vertex(unsigned(t.z)));
    switch (method) {
        case CgalMethod::leastSquaresConformal:
            return mapWith(mesh, parameterization::LSCM_parameterizer_3<Mesh>());
        case CgalMethod::asRigidAsPossible:
            return mapWith(mesh, parameterization::ARAP_parameterizer_3<Mesh>());
        case CgalMethod::discreteConformal: {
            const auto corner = [&](int n) { return Vertex(unsigned(corners[n])); };
            return mapWith(mesh,
                           parameterization::Discrete_conformal_map_parameterizer_3<Mesh, Square>(
                               Square(corner(0), corner(1), corner(2), corner(3))));
        }
    }
    return {};
}

}  // namespace haustra::bench
