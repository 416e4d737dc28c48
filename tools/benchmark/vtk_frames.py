"""Renders a scene with one of VTK's volume mappers, times the frames, saves the picture. Started by emission_vs_vtk.py and
modes_vs_vtk.py.

Debian's VTK 9.1 makes its contexts with GLX only, so this runs under xvfb-run, where Mesa's llvmpipe draws.
VTK's frame buffer has 8 bits a channel, from which the picture is read: an error of 0.0011 (1 / 255 / sqrt(12)) is the
rounding. Both mappers write premultiplied colours over a black background of alpha 0, without gamma."""
# SPDX-License-Identifier: Apache-2.0
import json
import sys
import time

import numpy as np
import vtk
from vtk.util import numpy_support

TABLE_POINTS = 4096


def image_data(voxels, spacing):
    image = vtk.vtkImageData()
    image.SetDimensions(*voxels.shape[::-1])
    image.SetSpacing(*spacing)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(voxels.reshape(-1), deep=False))
    return image


def volume_property(points, low, high):
    """Our transfer function in VTK's terms: opacity over a unit of length is 1 - exp(-sigma_t)."""
    colour, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    values = [p["value"] for p in points]
    for value in np.linspace(low, high, TABLE_POINTS):
        sigma_t = np.interp(value, values, [p["sigma_t"] for p in points])
        opacity.AddPoint(value, -np.expm1(-sigma_t))
        colour.AddRGBPoint(value, *(np.interp(value, values, [p["albedo"][i] for p in points]) for i in range(3)))
    result = vtk.vtkVolumeProperty()
    result.SetColor(colour)
    result.SetScalarOpacity(opacity)
    result.SetScalarOpacityUnitDistance(1)
    result.SetInterpolationTypeToLinear()
    result.ShadeOff()
    return result


def make_mapper(kind, distance):
    if kind in ("gpu", "iso", "gpu-mip"):
        mapper = vtk.vtkOpenGLGPUVolumeRayCastMapper()
        mapper.SetUseJittering(0)
        mapper.SetMaxMemoryInBytes(1 << 34)
        mapper.SetMaxMemoryFraction(1)
    else:
        mapper = vtk.vtkFixedPointVolumeRayCastMapper()
        mapper.SetInteractiveSampleDistance(distance)
    mapper.SetAutoAdjustSampleDistances(0)
    mapper.SetLockSampleDistanceToInputSpacing(0)
    mapper.SetImageSampleDistance(1)
    mapper.SetSampleDistance(distance)
    if kind == "iso":
        mapper.SetBlendModeToIsoSurface()
    elif kind.endswith("mip"):
        mapper.SetBlendModeToMaximumIntensity()
    return mapper


def set_mode(kind, scene, low, high, properties):
    """Surfaces are white and lit by Phong's model, and a maximum is a grey level in proportion to the value."""
    white, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    white.AddRGBPoint(low, 1, 1, 1)
    opacity.AddPoint(low, 1 if kind == "iso" else 0)
    opacity.AddPoint(high, 1)
    properties.SetColor(white)
    properties.SetScalarOpacity(opacity)
    if kind != "iso":
        return
    properties.GetIsoSurfaceValues().SetValue(0, scene["iso"])
    properties.ShadeOn()
    ambient, diffuse, specular, shininess = scene["phong"]
    properties.SetAmbient(ambient)
    properties.SetDiffuse(diffuse)
    properties.SetSpecular(specular)
    properties.SetSpecularPower(shininess)


def main(kind, scene_path, frames, output):
    with open(scene_path) as file:
        scene = json.load(file)
    voxels = np.load(scene["voxels"])
    camera = scene["camera"]
    mapper = make_mapper(kind, scene["voxelsPerSample"] * min(scene["spacing"]))
    mapper.SetInputData(image_data(voxels, scene["spacing"]))
    volume = vtk.vtkVolume()
    volume.SetMapper(mapper)
    properties = volume_property(scene["points"], float(voxels.min()), float(voxels.max()))
    if kind not in ("gpu", "cpu"):
        set_mode(kind, scene, float(voxels.min()), float(voxels.max()), properties)
    volume.SetProperty(properties)

    renderer = vtk.vtkRenderer()
    renderer.SetBackground(0, 0, 0)
    renderer.SetBackgroundAlpha(0)
    renderer.AddVolume(volume)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetAlphaBitPlanes(1)
    window.SetSize(camera["width"], camera["height"])
    window.AddRenderer(renderer)
    view = renderer.GetActiveCamera()
    view.SetPosition(*camera["eye"])
    view.SetFocalPoint(*camera["lookAt"])
    view.SetViewUp(*camera["up"])
    if "viewHeight" in camera:
        view.ParallelProjectionOn()
        view.SetParallelScale(camera["viewHeight"] / 2)
    else:
        view.SetViewAngle(camera["fov"])
    renderer.ResetCameraClippingRange()

    elapsed = []
    for _ in range(frames + 1):
        start = time.perf_counter()
        window.Render()
        window.WaitForCompletion()
        elapsed.append((time.perf_counter() - start) * 1000)
    pixels = vtk.vtkUnsignedCharArray()
    window.GetRGBACharPixelData(0, 0, camera["width"] - 1, camera["height"] - 1, 0, pixels)
    picture = numpy_support.vtk_to_numpy(pixels).reshape(camera["height"], camera["width"], 4) / 255
    np.save(output + ".npy", picture.astype(np.float32))
    renderer_name = [line.split(":", 1)[1].strip() for line in window.ReportCapabilities().splitlines()
                     if line.startswith("OpenGL renderer string")]
    with open(output + ".json", "w") as file:
        json.dump({"frames_ms": elapsed[1:], "first_ms": elapsed[0], "gl": (renderer_name or [""])[0]}, file)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4])
