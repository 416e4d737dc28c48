#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests VTK's volume mappers against a kit of umbrick check, as any renderer can be tested:

    umbrick check --export kit
    xvfb-run -a python3 tools/examples/test_vtk_against_kit.py kit --mapper gpu
    umbrick check --against kit

Reads the files of the kit as its README.md says, without umbrick and without OpenVDB, renders each picture off screen and writes the
answers. On Debian: apt-get install python3-vtk9 python3-numpy xvfb
"""
import argparse
import csv
import json
import pathlib

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy


def read_image(case, folder):
    """The dense voxels in index space: spacing 1, the first voxel's centre at its index."""
    volume = case["volume"]
    voxels = np.fromfile(folder / volume["raw"], dtype="<f4")
    image = vtk.vtkImageData()
    image.SetDimensions(*volume["dims"])
    image.SetOrigin(*volume["first_voxel"])
    image.GetPointData().SetScalars(numpy_to_vtk(voxels, deep=True))
    return image


def to_vtk_matrix(rows):
    matrix = vtk.vtkMatrix4x4()
    for i, row in enumerate(rows):
        for j, number in enumerate(row):
            matrix.SetElement(i, j, number)
    return matrix


def place_in_world(image, case, actor):
    """An image has an origin and a spacing; what turns, mirrors or shears is left to the matrix of the actor."""
    matrix = np.array(case["volume"]["index_to_world"])
    spacing = np.linalg.norm(matrix[:3, :3], axis=0)
    directions = matrix[:3, :3] / spacing
    if np.allclose(directions, np.eye(3), atol=1e-9):
        first = matrix @ np.append(case["volume"]["first_voxel"], 1)
        image.SetOrigin(*first[:3])
        image.SetSpacing(*spacing)
    else:
        actor.SetUserMatrix(to_vtk_matrix(case["volume"]["index_to_world"]))
    return spacing.min()


def read_transfer(folder):
    with open(folder / "transfer.csv", newline="") as file:
        return [[float(row[name]) for name in ("value", "albedo_r", "albedo_g", "albedo_b", "sigma_t")] for row in csv.DictReader(file)]


def make_property(transfer, value_range, light, unit):
    """Opacity a of a way `unit` is 1 - exp(-sigma_t unit), which is not linear where sigma_t is: it gets many points."""
    values, red, green, blue, sigma = np.array(transfer).T
    opacity, colour = vtk.vtkPiecewiseFunction(), vtk.vtkColorTransferFunction()
    dense = np.unique(np.concatenate([values, np.linspace(*value_range, 2049)]))
    for value in dense:
        opacity.AddPoint(value, 1 - np.exp(-np.interp(value, values, sigma) * unit))
        colour.AddRGBPoint(value, *(np.interp(value, values, channel) * l for channel, l in zip((red, green, blue), light)))
    made = vtk.vtkVolumeProperty()
    made.SetColor(colour)
    made.SetScalarOpacity(opacity)
    made.SetScalarOpacityUnitDistance(unit)
    made.SetInterpolationTypeToLinear()
    made.ShadeOff()
    return made


def make_mapper(kind, step):
    mapper = vtk.vtkGPUVolumeRayCastMapper() if kind == "gpu" else vtk.vtkFixedPointVolumeRayCastMapper()
    mapper.SetSampleDistance(step)
    mapper.SetAutoAdjustSampleDistances(False)
    if kind == "gpu":
        mapper.SetUseJittering(False)
    else:
        mapper.SetInteractiveSampleDistance(step)
        mapper.SetImageSampleDistance(1)
    mapper.SetBlendModeToComposite()
    return mapper


def place_camera(camera, picture):
    camera.SetPosition(*picture["eye"])
    camera.SetFocalPoint(*picture["look_at"])
    camera.SetViewUp(*picture["up"])
    if picture["projection"] == "perspective":
        camera.SetViewAngle(picture["fov_y_degrees"])
    else:
        camera.ParallelProjectionOn()
        camera.SetParallelScale(picture["view_height"] / 2)
    camera.SetClippingRange(picture["clip_near"], picture["clip_far"])


def render(case, folder, picture, arguments):
    """Returns linear premultiplied RGBA, first row on top."""
    actor = vtk.vtkVolume()
    image = read_image(case, folder)
    voxel = place_in_world(image, case, actor)
    mapper = make_mapper(arguments.mapper, voxel / arguments.steps)
    mapper.SetInputData(image)
    actor.SetMapper(mapper)
    actor.SetProperty(make_property(read_transfer(folder), case["volume"]["value_range"], picture["light"], voxel / 4))
    renderer = vtk.vtkRenderer()
    renderer.AddVolume(actor)
    background = picture["background"]
    renderer.SetBackground(*(background or (0, 0, 0)))
    renderer.SetBackgroundAlpha(1 if background else 0)
    place_camera(renderer.GetActiveCamera(), picture)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetAlphaBitPlanes(True)
    window.SetMultiSamples(0)
    window.SetSize(picture["width"], picture["height"])
    window.AddRenderer(renderer)
    window.Render()
    if arguments.mapper == "gpu" and not mapper.IsRenderSupported(window, actor.GetProperty()):
        raise SystemExit("vtkGPUVolumeRayCastMapper is not supported by this OpenGL")
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.SetInputBufferTypeToRGBA()
    grab.ReadFrontBufferOff()
    grab.ShouldRerenderOff()
    grab.Update()
    output = grab.GetOutput()
    width, height, _ = output.GetDimensions()
    pixels = vtk_to_numpy(output.GetPointData().GetScalars()).reshape(height, width, 4).astype("<f4") / 255
    if background:
        pixels[..., 3] = 1
    return pixels[::-1].copy()


def probe(case, folder):
    """The image's own interpolation at the points, in index coordinates; what it does not know is background."""
    with open(folder / "samples.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    for row in rows:
        points.InsertNextPoint(float(row["i"]), float(row["j"]), float(row["k"]))
    cloud = vtk.vtkPolyData()
    cloud.SetPoints(points)
    image = read_image(case, folder)
    image.GetPointData().GetScalars().SetName("value")
    probe_filter = vtk.vtkProbeFilter()
    probe_filter.SetInputData(cloud)
    probe_filter.SetSourceData(image)
    probe_filter.Update()
    data = probe_filter.GetOutput().GetPointData()
    values, valid = vtk_to_numpy(data.GetArray("value")), vtk_to_numpy(data.GetArray("vtkValidPointMask"))
    background = case["volume"]["background"]
    return [(row["id"], value if known else background) for row, value, known in zip(rows, values, valid)]


def main():
    parser = argparse.ArgumentParser(description="Answers a kit of umbrick check with VTK.")
    parser.add_argument("kit", type=pathlib.Path)
    parser.add_argument("--mapper", choices=("gpu", "fixed-point"), default="gpu")
    parser.add_argument("--steps", type=float, default=4, help="samples a voxel (shortest edge) [4]")
    arguments = parser.parse_args()
    for name in json.loads((arguments.kit / "kit.json").read_text())["cases"]:
        folder, answers = arguments.kit / "cases" / name, arguments.kit / "answers" / name
        case = json.loads((folder / "case.json").read_text())
        answers.mkdir(parents=True, exist_ok=True)
        with open(answers / "samples.csv", "w") as file:
            file.write("id,value\n")
            file.writelines(f"{number},{float(value)!r}\n" for number, value in probe(case, folder))
        for picture in case["pictures"]:
            np.save(answers / (picture["name"] + ".npy"), render(case, folder, picture, arguments))
        print(name, "answered")


if __name__ == "__main__":
    main()
