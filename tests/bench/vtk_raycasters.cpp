#include "vtk_raycasters.h"

#include <algorithm>
#include <thread>

#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkShortArray.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2)

namespace haustra::bench {

struct VtkRaycaster::Impl {
    Volume<std::int16_t> kept;
    glm::dmat4 localFromPatient{1.0};  // millimetres along the grid's axes
    bool mirrored = false;
    vtkNew<vtkImageData> image;
    vtkSmartPointer<vtkVolumeMapper> mapper;
    vtkNew<vtkVolume> volume;
    vtkNew<vtkRenderer> renderer;
    vtkNew<vtkRenderWindow> window;

    void draw(const render::CameraView& view, Image& picture);
};

VtkRaycaster::VtkRaycaster(VtkMapper kind, const Volume<std::int16_t>& volume, int threads)
    : impl_(std::make_unique<Impl>()) {
    Impl& my = *impl_;
    my.kept = volume.share();
    const Grid& grid = volume.grid();
    const glm::dvec3 spacing = grid.spacingMm();
    glm::dmat4 localFromVoxel(1.0);
    for (int axis = 0; axis < 3; ++axis)
        localFromVoxel[axis][axis] = spacing[axis];
    my.localFromPatient = localFromVoxel * grid.voxelFromPatient();
    my.mirrored = glm::determinant(glm::dmat3(my.localFromPatient)) < 0.0;
    vtkNew<vtkShortArray> voxels;
    voxels->SetArray(const_cast<short*>(my.kept.voxels().data()),
                     vtkIdType(my.kept.voxels().size()), 1);
    my.image->SetDimensions(grid.size.x, grid.size.y, grid.size.z);
    my.image->SetSpacing(spacing.x, spacing.y, spacing.z);
    my.image->GetPointData()->SetScalars(voxels);
    if (kind == VtkMapper::gpu) {
        vtkNew<vtkGPUVolumeRayCastMapper> mapper;
        mapper->SetAutoAdjustSampleDistances(0);
        mapper->SetUseJittering(0);
        my.mapper = mapper;
    } else {
        vtkNew<vtkFixedPointVolumeRayCastMapper> mapper;
        mapper->SetAutoAdjustSampleDistances(0);
        mapper->SetNumberOfThreads(threads);
        my.mapper = mapper;
    }
    my.mapper->SetInputData(my.image);
    my.volume->SetMapper(my.mapper);
    my.renderer->AddVolume(my.volume);
    my.renderer->SetBackground(0.0, 0.0, 0.0);
    my.window->SetOffScreenRendering(1);
    my.window->SetMultiSamples(0);
    my.window->AddRenderer(my.renderer);
}

VtkRaycaster::~VtkRaycaster() {
    std::thread([this] { impl_.reset(); }).join();
}

Image VtkRaycaster::render(const render::CameraView& view, int width, int height) {
    Image image{width, height,
                std::vector<std::uint8_t>(3 * std::size_t(width) * std::size_t(height))};
    // A thread has one current context, and the caller's may be another window system's.
    std::thread([&] { impl_->draw(view, image); }).join();
    return image;
}

void VtkRaycaster::Impl::draw(const render::CameraView& view, Image& picture) {
    Impl& my = *this;
    const int width = picture.width, height = picture.height;
    vtkNew<vtkPiecewiseFunction> opacity;
    vtkNew<vtkColorTransferFunction> color;
    for (const render::TransferFunctionPoint& p : view.optics.transferFunction.points) {
        opacity->AddPoint(p.hu, p.opacity);
        color->AddRGBPoint(p.hu, p.color.r, p.color.g, p.color.b);
    }
    vtkNew<vtkVolumeProperty> property;
    property->SetScalarOpacity(opacity);
    property->SetColor(color);
    property->SetScalarOpacityUnitDistance(1.0);
    property->SetInterpolationTypeToLinear();
    property->SetShade(view.optics.shading);
    property->SetAmbient(view.optics.light.ambient);
    property->SetDiffuse(view.optics.light.diffuse);
    property->SetSpecular(view.optics.light.specular);
    property->SetSpecularPower(view.optics.light.shininess);
    my.volume->SetProperty(property);
    const glm::dvec3 spacing = my.kept.grid().spacingMm();
    const double step = view.march.stepVoxels * std::min(spacing.x, std::min(spacing.y, spacing.z));
    if (auto* gpu = vtkGPUVolumeRayCastMapper::SafeDownCast(my.mapper))
        gpu->SetSampleDistance(float(step));
    if (auto* fixed = vtkFixedPointVolumeRayCastMapper::SafeDownCast(my.mapper)) {
        fixed->SetSampleDistance(float(step));
        fixed->SetInteractiveSampleDistance(float(step));
        fixed->SetImageSampleDistance(1.0f);
    }

    const glm::dvec3 eye(my.localFromPatient * glm::dvec4(view.camera.positionMm, 1.0));
    const glm::dmat3 turn(my.localFromPatient);
    const glm::dvec3 ahead = eye + turn * glm::normalize(view.camera.forward);
    const glm::dvec3 up = turn * view.camera.up;
    vtkCamera* camera = my.renderer->GetActiveCamera();
    camera->SetPosition(eye.x, eye.y, eye.z);
    camera->SetFocalPoint(ahead.x, ahead.y, ahead.z);
    camera->SetViewUp(up.x, up.y, up.z);
    camera->SetViewAngle(view.camera.fovDegrees);
    camera->SetClippingRange(0.1, 2000.0);
    my.window->SetSize(width, height);
    my.window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    my.window->GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, pixels);

    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                picture.rgb[3 * std::size_t(y * width + x) + std::size_t(c)] = pixels->GetValue(
                    4 * vtkIdType((height - 1 - y) * width + (my.mirrored ? width - 1 - x : x)) +
                    c);
    window->ReleaseCurrent();
}

}  // namespace haustra::bench
