"""How fast ParaView draws the bundled head anew after an edit, beside view_latency.py:

    xvfb-run -a pvpython tools/benchmark/paraview_latency.py [--edits 20] [--picture paraview.png]

512 x 512, volume rendering with the function of assets/transfer/ct-head.json (ParaView has no occlusion of cones, so that this is
the unlit picture). A move of the camera is an interactive render, in which ParaView lowers its sampling rate by itself; an edit of the
function and the picture at rest are still renders. Times are of the call that draws. Needs Debian's paraview, python3-paraview, xvfb.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import gzip
import json
import pathlib
import statistics
import tempfile
import time

import numpy as np
from paraview import simple

TOP = pathlib.Path(__file__).resolve().parent.parent.parent


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--edits", type=int, default=20, help="of each kind")
    parser.add_argument("--picture", help="where the last picture is written")
    arguments = parser.parse_args()
    points = json.loads((TOP / "assets/transfer/ct-head.json").read_text())["points"]
    with tempfile.TemporaryDirectory() as folder:
        raw = pathlib.Path(folder) / "head.raw"
        with gzip.open(TOP / "assets/headsq_256x256x94_uint16le.raw.gz") as packed:
            # Fifteen bits hold the value.
            (np.frombuffer(packed.read(), "<u2") & 0x7fff).tofile(raw)
        head = simple.ImageReader(FileNames=[str(raw)], DataScalarType="unsigned short", DataByteOrder="LittleEndian",
                                  DataExtent=[0, 255, 0, 255, 0, 93], DataSpacing=[0.8, 0.8, 1.5])
        head.UpdatePipeline()
        view = simple.CreateRenderView(ViewSize=[512, 512], Background=[0, 0, 0], UseColorPaletteForBackground=0)
        shown = simple.Show(head, view, "UniformGridRepresentation")
        shown.SetRepresentationType("Volume")
        simple.ColorBy(shown, ("POINTS", head.PointData.GetArray(0).Name))
        name = head.PointData.GetArray(0).Name
        colours, opacities = simple.GetColorTransferFunction(name), simple.GetOpacityTransferFunction(name)
        colours.RGBPoints = [number for each in points for number in [each["value"], *each["albedo"]]]
        shown.ScalarOpacityUnitDistance = 1

        def opacity(factor):
            return [number for each in points
                    for number in [each["value"], 1 - 2.718281828 ** (-each["sigma_t"] * factor), 0.5, 0]]
        opacities.Points = opacity(1)
        view.CameraFocalPoint, view.CameraPosition = [102, 102, 70], [102, -600, 70]
        view.CameraViewUp, view.CameraViewAngle = [0, 0, -1], 30
        simple.ResetCamera(view)
        camera = simple.GetActiveCamera()
        camera.Azimuth(30)
        simple.Render(view)
        times = {"camera, interactive": [], "transfer function, still": [], "camera, still": []}
        for i in range(arguments.edits):
            camera.Azimuth(2)
            began = time.perf_counter()
            view.SMProxy.InteractiveRender()
            times["camera, interactive"].append(time.perf_counter() - began)
        for i in range(arguments.edits):
            opacities.Points = opacity(1 - 0.01 * (i + 1))
            began = time.perf_counter()
            simple.Render(view)
            times["transfer function, still"].append(time.perf_counter() - began)
        for i in range(arguments.edits):
            camera.Azimuth(2)
            began = time.perf_counter()
            simple.Render(view)
            times["camera, still"].append(time.perf_counter() - began)
        if arguments.picture:
            simple.SaveScreenshot(arguments.picture, view, ImageResolution=[512, 512])
    for name, each in times.items():
        each = sorted(1000 * t for t in each)
        print(f"{name:28} median {statistics.median(each):8.0f} ms, 95th percentile {each[int(0.95 * len(each))]:8.0f} ms")


if __name__ == "__main__":
    main()
