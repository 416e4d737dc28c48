"""The picture that the renderers are judged by: the emission model integrated ray by ray in double precision.

Per sample of length ds: C += T (1 - exp(-sigma_t ds)) albedo, T *= exp(-sigma_t ds), in the middle of steps of 1/16 of
the shortest voxel edge; trilinear values, transfer function evaluated without a table. Rays stop at T < 1e-7."""
# SPDX-License-Identifier: Apache-2.0
import multiprocessing
import os

import numpy as np

STEPS_PER_VOXEL = 16
BLOCK = 8  # voxels; samples in a block where the transfer function is 0 are not computed


class March:
    def __init__(self, voxels, spacing, points, camera):
        self.voxels, self.spacing, self.camera = voxels, np.array(spacing, float), camera
        self.values = np.array([p["value"] for p in points], float)
        self.media = np.array([p["albedo"] + [p["sigma_t"]] for p in points], float)
        # Beyond the ends the function is constant.
        self.dims = np.array(voxels.shape[::-1])
        self.occupied = self.find_occupied()

    def find_occupied(self):
        """Per block: may a sample between its voxels, the next ones included, see anything?"""
        counts = [-(-int(n) // BLOCK) for n in self.voxels.shape]
        occupied = np.zeros(counts, bool)
        for k in range(counts[0]):
            slab = self.voxels[k * BLOCK:(k + 1) * BLOCK + 1]
            for j in range(counts[1]):
                row = slab[:, j * BLOCK:(j + 1) * BLOCK + 1]
                low, high = row.min((0, 1)), row.max((0, 1))
                for i in range(counts[2]):
                    part = slice(i * BLOCK, (i + 1) * BLOCK + 1)
                    occupied[k, j, i] = self.largest_sigma(low[part].min(), high[part].max()) > 0
        return occupied

    def largest_sigma(self, low, high):
        between = self.media[(self.values >= low) & (self.values <= high), 3]
        return max(np.interp([low, high], self.values, self.media[:, 3]).max(), between.max(initial=0))

    def rays(self, rows):
        """Origins and directions in index space, entry and exit distance in world units, of the pixels of some rows."""
        c = self.camera
        eye, look_at, up = (np.array(c[k], float) for k in ("eye", "lookAt", "up"))
        forward = (look_at - eye) / np.linalg.norm(look_at - eye)
        right = np.cross(forward, up)
        right /= np.linalg.norm(right)
        up = np.cross(right, forward)
        half = np.tan(np.radians(c["fov"]) / 2)
        x = ((np.arange(c["width"]) + 0.5) / c["width"] * 2 - 1) * half * c["width"] / c["height"]
        y = ((np.array(rows) + 0.5) / c["height"] * 2 - 1) * half
        direction = (forward + x[None, :, None] * right + y[:, None, None] * up).reshape(-1, 3)
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        with np.errstate(divide="ignore"):
            a, b = (0 - eye) / direction, ((self.dims - 1) * self.spacing - eye) / direction
        enter = np.maximum(np.minimum(a, b).max(1), 0)
        return eye / self.spacing, direction / self.spacing, enter, np.maximum(a, b).min(1)

    def sample(self, p):
        """Trilinear values at index-space points inside the volume."""
        base = np.clip(p.astype(np.int64), 0, self.dims - 2)
        t = p - base
        sx, sy = int(self.dims[0]), int(self.dims[0] * self.dims[1])
        at = base[:, 2] * sy + base[:, 1] * sx + base[:, 0]
        flat = self.voxels.reshape(-1)
        corner = [flat[at + i + j * sx + k * sy].astype(float) for k in (0, 1) for j in (0, 1) for i in (0, 1)]
        tx, ty, tz = t.T
        along_x = [corner[i] + (corner[i + 1] - corner[i]) * tx for i in (0, 2, 4, 6)]
        along_y = [along_x[i] + (along_x[i + 1] - along_x[i]) * ty for i in (0, 2)]
        return along_y[0] + (along_y[1] - along_y[0]) * tz

    def march_rows(self, rows, batch=128):
        origin, direction, enter, leave = self.rays(rows)
        picture = np.zeros((len(enter), 4))
        ds = self.spacing.min() / STEPS_PER_VOXEL
        alive = np.flatnonzero(leave > enter)
        transmitted = np.ones(len(enter))
        first = 0
        while alive.size:
            distance = enter[alive, None] + (first + np.arange(batch) + 0.5) * ds
            inside = distance < leave[alive, None]
            p = origin + distance[..., None] * direction[alive, None]
            block = np.clip(p.astype(np.int32) // BLOCK, 0, np.array(self.occupied.shape[::-1]) - 1)
            seen = inside & self.occupied[block[..., 2], block[..., 1], block[..., 0]]
            if seen.any():
                value = self.sample(p[seen])
                medium = np.zeros(seen.shape + (4,))
                medium[seen] = np.stack([np.interp(value, self.values, channel) for channel in self.media.T], 1)
                tau = medium[..., 3] * ds
                before = np.cumsum(tau, 1) - tau
                weight = transmitted[alive, None] * np.exp(-before) * -np.expm1(-tau)
                picture[alive, :3] += (weight[..., None] * medium[..., :3]).sum(1)
                picture[alive, 3] += weight.sum(1)
                transmitted[alive] *= np.exp(-tau.sum(1))
            first += batch
            alive = alive[(enter[alive] + first * ds < leave[alive]) & (transmitted[alive] > 1e-7)]
        return picture.reshape(len(rows), self.camera["width"], 4)


def march(voxels, spacing, points, camera):
    """height x width x RGBA, linear, premultiplied, row 0 at the bottom."""
    work = March(voxels, spacing, points, camera)
    global rows_of  # a forked process finds the volume here, without a copy
    rows_of = work.march_rows
    pieces = [range(y, min(y + 4, camera["height"])) for y in range(0, camera["height"], 4)]
    with multiprocessing.get_context("fork").Pool(os.cpu_count()) as pool:
        return np.concatenate(pool.map(_march_piece, pieces, chunksize=1))


def _march_piece(rows):
    return rows_of(rows)
