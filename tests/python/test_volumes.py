# Arrays and files as volumes: places, orders, dtypes, losses; nibabel and pyopenvdb.
# SPDX-License-Identifier: Apache-2.0
import subprocess
import sys
import tracemalloc

import numpy as np
import pytest

import umbrick
from conftest import one_line, ramp

DTYPES = ["?", "u1", "i1", "<u2", ">u2", "<i2", ">i2", "<u4", "<i4", ">i4", "<i8", ">u8", "<f2", "<f4", ">f4", "<f8", ">f8"]


@pytest.mark.parametrize("dtype", DTYPES)
def test_every_dtype_keeps_its_values(dtype):
    array = ramp().astype(dtype)  # bool: all True
    volume = umbrick.convert(array)
    assert volume.box == ((0, 0, 0), (6, 4, 2))
    np.testing.assert_array_equal(volume.array(), array.astype(np.float32))


# Orders in memory, steps and axes that run backwards: the same numbers in the same places.
@pytest.mark.parametrize("arranged", [
    lambda a: np.ascontiguousarray(a),
    lambda a: np.asfortranarray(a),
    lambda a: np.ascontiguousarray(a.transpose(2, 0, 1)).transpose(1, 2, 0),
    lambda a: np.repeat(np.repeat(a, 2, 0), 3, 2)[::2, :, ::3],
    lambda a: np.ascontiguousarray(a[::-1, :, ::-1])[::-1, :, ::-1],
])
def test_order_in_memory_does_not_matter(arranged):
    array = arranged(ramp())
    np.testing.assert_array_equal(umbrick.convert(array).array(), ramp())
    np.testing.assert_array_equal(umbrick.convert(array.transpose(), axes="zyx").array(), ramp())


# A slab that is read at once has more rows than are gathered together.
def test_large_slabs_are_gathered_whole():
    array = np.random.default_rng(1).random((150, 40, 70), np.float32) + 1
    np.testing.assert_array_equal(umbrick.convert(array).array(), array)


def test_two_axes_are_one_slice_and_components_stand_last():
    np.testing.assert_array_equal(umbrick.convert(ramp((4, 3))).array()[:, :, 0], ramp((4, 3)))
    vectors = ramp((4, 3, 2, 3))
    np.testing.assert_array_equal(umbrick.convert(vectors, component=1).array(), vectors[..., 1])
    length = umbrick.convert(vectors.transpose(2, 1, 0, 3), component="magnitude", axes="zyx").array()
    np.testing.assert_allclose(length, np.linalg.norm(vectors, axis=-1), rtol=1e-6)  # rounded to float once more


def test_python_makes_no_copy_of_an_array():
    array = np.ones((128, 128, 64), np.float64)  # 8 MiB
    tracemalloc.start()
    umbrick.convert(array.transpose(1, 0, 2)[::-1])
    peak = tracemalloc.get_traced_memory()[1]  # NumPy's memory is traced
    tracemalloc.stop()
    assert peak < array.nbytes / 8


def test_place_follows_spacing_origin_and_affine():
    volume = umbrick.convert(ramp(), spacing=(1, 2, 3), origin=(10, 20, 30))
    np.testing.assert_array_equal(volume.affine, [[1, 0, 0, 10], [0, 2, 0, 20], [0, 0, 3, 30], [0, 0, 0, 1]])
    centimetres = umbrick.convert(ramp(), length_unit="cm", space="lps").info()["metadata"]
    assert (centimetres["length_unit"], centimetres["space"]) == ("cm", "LPS")
    oblique = np.array([[0, -2, 0.5, 1], [1.5, 0, 0, 2], [0, 0.25, 3, -4], [0, 0, 0, 1]])
    np.testing.assert_allclose(umbrick.convert(ramp(), affine=oblique).affine, oblique, atol=1e-15)
    with pytest.raises(umbrick.InvalidArgument) as error:
        umbrick.convert(ramp(), affine=oblique, spacing=(1, 1, 1))
    assert "affine" in one_line(error)


def test_arrays_are_read_as_numpy_files_are(tmp_path, program):
    array = ramp()
    np.save(tmp_path / "c.npy", array)  # C order: x is the last axis
    program("convert", tmp_path / "c.npy", "-o", tmp_path / "c.vdb", "--spacing", 1, 2, 3)
    file, memory = umbrick.Volume.open(tmp_path / "c.vdb"), umbrick.convert(array, axes="zyx", spacing=(1, 2, 3))
    assert file.box == memory.box == ((0, 0, 0), (2, 4, 6))
    np.testing.assert_array_equal(file.array(), memory.array())
    np.testing.assert_array_equal(file.affine, memory.affine)


def test_losses_are_those_of_numpy():
    array = np.random.default_rng(2).normal(0, 10, (20, 30, 10)).astype(np.float32)
    volume = umbrick.convert(array, max_error=0.25)
    error = np.abs(volume.array(((0, 0, 0), (19, 29, 9))) - array)
    assert error.max() <= 0.25
    assert volume.losses["max_error"] == pytest.approx(error.max(), rel=1e-6)
    with pytest.warns(umbrick.UmbrickWarning, match="become background"):
        clipped = umbrick.convert(array, range=(1, 5))
    assert clipped.losses["clipped_voxels"] == np.count_nonzero((array < 1) | (array > 5))
    array[3, 2, 1] = np.nan
    with pytest.warns(umbrick.UmbrickWarning, match="1 voxels are not finite"):
        assert umbrick.convert(array).losses["non_finite"] == 1
    # 2^53 - 1 is no 32-bit float.
    assert umbrick.convert(np.full((4, 4, 4), 2**53 - 1)).losses["conversion_error"] == 1


def test_crop_and_info_and_box():
    volume = umbrick.convert(ramp(), crop=((1, 1, 0), (3, 4, 1)), name="pressure", unit="Pa")
    assert volume.box == ((0, 0, 0), (2, 3, 1))
    np.testing.assert_array_equal(volume.affine[:3, 3], [1, 1, 0])  # where they were
    np.testing.assert_array_equal(volume.array(), ramp()[1:4, 1:, :2])
    info = volume.info(bins=4)
    assert info["dims"] == (3, 4, 2) and info["active_voxels"] == 24 and sum(info["histogram"]) == 24
    assert (info["min"], info["max"]) == (ramp()[1, 1, 0], ramp()[3, 4, 1])
    assert (info["name"], info["unit"]) == ("pressure", "Pa")
    np.testing.assert_array_equal(volume.array(((0, 0, 0), (6, 4, 2)))[3:], 0)  # the background


def test_saved_files_come_back(tmp_path):
    volume = umbrick.convert(ramp(dtype=np.uint16), spacing=(1, 2, 3))
    for name in ["a.vdb", "a.nvdb", "a.nrrd", "a.mhd"]:
        volume.save(tmp_path / name)
        back = umbrick.Volume.open(tmp_path / name)
        np.testing.assert_array_equal(back.array(volume.box), volume.array())
        np.testing.assert_allclose(back.affine, volume.affine)
    assert b"type: uint16" in (tmp_path / "a.nrrd").read_bytes()[:200].replace(b"unsigned short", b"uint16")
    packed = volume.save(tmp_path / "q.nvdb", quantise=8)
    error = np.abs(umbrick.Volume.open(tmp_path / "q.nvdb").array(volume.box) - volume.array()).max()
    assert 0 < error <= packed["max_error"] * (1 + 1e-6)


def test_nibabel_images_lie_as_the_program_puts_them(tmp_path, program):
    nibabel = pytest.importorskip("nibabel")
    oblique = np.array([[-2, 0.1, 0, 90], [0.1, 2, 0.3, -126], [0, -0.3, 2.5, -72], [0, 0, 0, 1]])
    image = nibabel.Nifti1Image(ramp((6, 5, 4), np.int16), oblique)
    image.header.set_xyzt_units("mm")
    image.header.set_slope_inter(0.5, -3)
    nibabel.save(image, tmp_path / "scan.nii.gz")
    program("convert", tmp_path / "scan.nii.gz", "-o", tmp_path / "scan.vdb")
    loaded = nibabel.load(tmp_path / "scan.nii.gz")
    file = umbrick.Volume.open(tmp_path / "scan.vdb")
    for memory in [umbrick.convert(loaded), umbrick.convert(tmp_path / "scan.nii.gz"),
                   umbrick.convert(loaded.get_fdata(), affine=loaded.affine, space="ras", length_unit="mm")]:
        assert memory.box == file.box
        np.testing.assert_array_equal(memory.array(), file.array())
        np.testing.assert_array_equal(memory.affine, file.affine)
        for key in ["space", "length_unit"]:
            assert memory.info()["metadata"][key] == file.info()["metadata"][key]
    np.testing.assert_allclose(file.affine, loaded.affine)
    # Where a value of 0 is background, it is not active: the box of all voxels has every one.
    np.testing.assert_array_equal(file.array(((0, 0, 0), (5, 4, 3))), loaded.get_fdata().astype(np.float32))


PYOPENVDB = """
import sys
{first}
{second}
import numpy as np
array = (np.arange(7 * 5 * 3).reshape(7, 5, 3) + 1).astype(np.float32)
volume = umbrick.convert(array, spacing=(1, 2, 3), origin=(10, 20, 30))
grid = volume.to_pyopenvdb()
assert type(grid) is pyopenvdb.FloatGrid and grid.name == "density" and grid.activeVoxelCount() == 105
values = np.zeros((7, 5, 3), np.float32)
grid.copyToArray(values)
assert (values == array).all()
assert grid.transform.indexToWorld((1, 1, 1)) == (11.0, 22.0, 33.0)
grid.copyFromArray(array * 2)
back = umbrick.Volume.from_pyopenvdb(grid)
assert (back.array() == array * 2).all() and (back.affine == volume.affine).all()
picture = umbrick.render(back, size=(16, 16), backend="cpu")
print("fine")
"""


@pytest.mark.parametrize("first, second", [("import umbrick", "import pyopenvdb"), ("import pyopenvdb", "import umbrick")])
def test_grids_go_to_pyopenvdb_and_back(first, second):
    pytest.importorskip("pyopenvdb")
    done = subprocess.run([sys.executable, "-c", PYOPENVDB.format(first=first, second=second)], capture_output=True,
                          text=True)
    assert done.stdout == "fine\n", done.stderr


def test_bad_arrays_and_keywords_are_one_clear_line(tmp_path):
    cases = [
        (ramp().astype(complex), {}, ["complex128", "dtype"]),
        (ramp((2, 2, 2, 9)), {}, ["(2, 2, 2, 9)"]),
        (ramp(), {"axes": "yxz"}, ["axes", "'yxz'"]),
        (ramp(), {"spacing": (1, 2)}, ["spacing", "(1, 2)"]),
        (ramp(), {"spacing": (1, 0, 1)}, ["spacing", "0"]),
        (ramp(), {"affine": np.zeros((4, 4))}, ["affine"]),
        (ramp(), {"affine": "here"}, ["affine", "'here'"]),
        (ramp(), {"tolerance": "much"}, ["tolerance", "'much'"]),
        (ramp(), {"tolerance": -1}, ["tolerance", "-1"]),
        (ramp(), {"max_error": 1, "tolerance": 1}, ["max_error", "tolerance"]),
        (ramp(), {"grid": "density"}, ["grid"]),
        (ramp((4, 3, 2, 3)), {}, ["component"]),
        (np.zeros((4, 4, 4)), {}, ["nothing is left"]),
        (tmp_path / "none.nii", {}, ["none.nii"]),
        (tmp_path, {}, [str(tmp_path)]),
    ]
    for source, keywords, words in cases:
        with pytest.raises(umbrick.Error) as error:
            umbrick.convert(source, **keywords)
        for word in words:
            assert word in one_line(error)
        assert "--" not in str(error.value)
    with pytest.raises(TypeError, match="source: expected an array"):
        umbrick.convert([1, 2, 3])
    with pytest.raises(OSError):
        umbrick.Volume.open(tmp_path / "none.vdb")
    with pytest.raises(ValueError):
        umbrick.convert(ramp()).save(tmp_path / "a.txt")
    with pytest.raises(umbrick.OutOfMemory) as error:
        umbrick.convert(ramp()).array(((0, 0, 0), (10**6, 10**6, 10**6)))
    assert "memory" in one_line(error)
