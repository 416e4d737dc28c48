#!/usr/bin/env python3
"""How fast `umbrick view` answers: edits to the first picture that shows them, and the way from there to a picture whose error
is known to be small; what the server needs at rest, and its memory beside that of `umbrick render`.

    view_latency.py --umbrick build/release/tools/umbrick [--edits 40] [--error 0.01] [INPUT and options of umbrick view ...]

It is a page without a browser: each time is from sending an edit on the WebSocket to having received and decoded the first
picture after it. Moves are sent as pages send drags, each after the picture of the one before; then the drag ends, and the time
until a picture at rest has the error is taken. Without an input: the bundled head, 512 x 512.
Needs Debian's python3-websockets, python3-pil and python3-numpy.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import asyncio
import io
import json
import os
import pathlib
import statistics
import struct
import subprocess
import tempfile
import time

import numpy as np
import websockets
from PIL import Image

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
HEAD = [str(TOP / "assets/headsq_256x256x94_uint16le.raw.gz"), *"--dims 256 256 94 --type u16 --bits-stored 15 --spacing 0.8 0.8 1.5"
        " --tf ct-head --up -z".split()]
PATIENCE = 120  # seconds for one answer


class Page:
    def __init__(self, socket):
        self.socket, self.scene, self.status, self.frames = socket, None, None, 0

    async def send(self, **message):
        await self.socket.send(json.dumps(message))

    async def receive(self):
        """Returns the header of a picture and its decoded pixels, or None and a message."""
        message = await asyncio.wait_for(self.socket.recv(), PATIENCE)
        if isinstance(message, bytes):
            length, = struct.unpack_from("<I", message)
            pixels = np.asarray(Image.open(io.BytesIO(message[4 + length:])).convert("RGB"))
            self.frames += 1
            head = json.loads(message[4:4 + length])
            await self.send(type="shown", frame=head["frame"])  # the server sends no other one before
            return head, pixels
        text = json.loads(message)
        if text["type"] == "status":
            self.status = text
        elif text["type"] == "scene":
            self.scene = text["scene"]
        elif text["type"] == "error":
            raise SystemExit(f"the server refuses: {text['message']}")
        return None, text

    async def until(self, accepts):
        """Waits until accepts(header of a picture or None, pixels or message) holds; returns seconds."""
        began = time.perf_counter()
        while not accepts(*await self.receive()):
            pass
        return time.perf_counter() - began

    async def rest(self):
        return await self.until(lambda head, text: head is None and text["type"] == "status" and text["done"])


def edits_of(scene, count):
    """Each kind of edit: a name and its patches, which all change a picture of the bundled head."""
    points = scene["transfer"]["points"]
    turns = [{"camera": {"azimuth": 31 + 2 * i}} for i in range(count)]

    def opacity(i):
        moved = json.loads(json.dumps(points))
        most = max(range(len(moved)), key=lambda at: moved[at].get("sigma_t", 0))
        moved[most]["sigma_t"] *= 1 - 0.01 * (i + 1)
        return {"transfer": {"points": moved}}

    def colour(i):
        moved = json.loads(json.dumps(points))
        for point in moved:
            point["albedo"] = [0.5 + 0.4 * ((i + axis) % 3 - 1) / (1 + 0.1 * i) for axis in range(3)]
        return {"transfer": {"points": moved}}
    yield "camera", turns
    yield "transfer function, opacity", [opacity(i) for i in range(count)]
    yield "transfer function, colour", [colour(i) for i in range(count)]
    yield "cone angle", [{"occlusion": {"theta": 59 - 0.5 * i}} for i in range(count)]
    yield "clip box", [{"clip": {"box": [[-1e4, -1e4, -1e4], [1e4, 1e4, 120 - 0.5 * i]]}} for i in range(count)]


def processor_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def most_memory(pid):
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) / 1024


async def measure(address, server, arguments):
    socket_address = address.replace("http:", "ws:").rstrip("/") + "/socket"
    origin = "/".join(address.split("/")[:3])
    async with websockets.connect(socket_address, origin=origin, max_size=None, compression=None) as socket:
        page = Page(socket)
        await page.rest()
        print(f"scene: {page.scene['model']}, {page.scene.get('method', '-')}; at rest: {page.status['text']}")
        print(f"{'edit':28}{'median':>8}{'p95':>8}{'largest':>9} ms{'first at rest':>15}{'error ' + str(arguments.error):>12} s")
        for name, patches in edits_of(page.scene, arguments.edits):
            times = []
            for patch in patches:
                await page.send(type="edit", patch=patch, step=name, moving=True)
                times.append(await page.until(lambda head, _: head is not None) * 1000)
            await page.send(type="rest")
            began = time.perf_counter()
            first, good = None, None
            while True:
                head, text = await page.receive()
                if head and not head["draft"] and first is None:
                    first = time.perf_counter() - began
                if head is None and text["type"] == "status":
                    if good is None and not text["draft"] and text["error"] is not None and text["error"] <= arguments.error:
                        good = time.perf_counter() - began
                    if text["done"]:
                        break
            percentile = sorted(times)[min(len(times) - 1, int(0.95 * len(times)))]
            print(f"{name:28}{statistics.median(times):8.0f}{percentile:8.0f}{max(times):9.0f}   "
                  f"{'-' if first is None else f'{first:.2f}':>15}{'-' if good is None else f'{good:.2f}':>12}")
        before, frames = processor_seconds(server.pid), page.frames
        await asyncio.sleep(5)
        print(f"at rest, 5 s: {processor_seconds(server.pid) - before:.2f} s of processor time")
        print(f"memory of the server, at most: {most_memory(server.pid):.0f} MiB")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--umbrick", required=True)
    parser.add_argument("--edits", type=int, default=40, help="of each kind")
    parser.add_argument("--error", type=float, default=0.01)
    arguments, options = parser.parse_known_args()
    options = options or HEAD
    print(f"load of the machine: {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores")
    server = subprocess.Popen([arguments.umbrick, "view", *options, "--no-browser"], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True)
    try:
        asyncio.run(measure(server.stdout.readline().strip(), server, arguments))
    finally:
        server.terminate()
        server.wait()
    with tempfile.TemporaryDirectory() as folder:
        picture = subprocess.Popen([arguments.umbrick, "render", *options, "-o", f"{folder}/picture.png"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        usage = os.wait4(picture.pid, 0)[2]
    print(f"memory of umbrick render, at most: {usage.ru_maxrss / 1024:.0f} MiB")


if __name__ == "__main__":
    main()
