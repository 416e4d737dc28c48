# Pictures: the same as the program's to the last bit, renderers that live, references, measures.
# SPDX-License-Identifier: Apache-2.0
import json
import threading

import numpy as np
import pytest

import umbrick
from conftest import one_line, ramp

SMALL = dict(size=(64, 48))


def program_picture(program, tmp_path, *arguments):
    path = tmp_path / "program.exr"
    program("render", *arguments, "-o", path, "--exr-pixel", "float", "--layers")
    return umbrick.Picture.open(path)


def assert_same(a, b):
    np.testing.assert_array_equal(np.asarray(a), np.asarray(b))
    assert a.layers.keys() == b.layers.keys()
    for name in a.layers:
        np.testing.assert_array_equal(a.layers[name], b.layers[name])
    assert a.scene == b.scene


# Nothing is said but the size: transfer function, model, view and zoom are chosen by both alike.
def test_the_first_picture_is_the_programs(head_file, program, tmp_path):
    by_program = program_picture(program, tmp_path, head_file, "--size", "64x48")
    by_python = umbrick.render(head_file, layers=True, **SMALL)
    assert_same(by_python, by_program)
    assert by_python.chosen["tf"] == "auto" and by_python.chosen["model"] == "cone"
    assert np.asarray(by_python)[..., 3].max() > 0.5


WORDS = [
    (["--tf", "ct-head", "--model", "cone", "--theta", 33.3, "--azimuth", 77.7, "--elevation", -12.3],
     dict(tf="ct-head", model="cone", theta=33.3, azimuth=77.7, elevation=-12.3)),
    (["--tf", "ct-bone", "--model", "emission", "--background", "white", "--samples", 2, "--no-culling", "--zoom", 1.2,
      "--clip-plane", 1, 0, 0, -90, "--sigma-scale", 0.5],
     dict(tf="ct-bone", model="emission", background="white", samples=2, no_culling=True, zoom=1.2,
          clip_planes=[(1, 0, 0, -90)], sigma_scale=0.5)),
    (["--mode", "isosurface", "--iso", "500,1150", "--iso-opacity", "0.4,1", "--view", "left", "--fov", 20],
     dict(mode="isosurface", iso=[500, 1150], iso_opacity=[0.4, 1], view="left", fov=20)),
    (["--backend", "osmesa", "--technique", "slices", "--model", "cone", "--method", "dos", "--footprint", 2, "--passes",
      2, "--spacing", 1.5],
     dict(backend="osmesa", technique="slices", model="cone", method="dos", footprint=2, passes=2, spacing=1.5)),
    (["--tf", "ct-head", "--progressive", 6, "--seed", 3, "--quality", "draft", "--backend", "cpu"],
     dict(tf="ct-head", progressive=6, seed=3, quality="draft", backend="cpu")),
]


@pytest.mark.parametrize("options, keywords", WORDS)
def test_the_same_words_make_the_same_picture(options, keywords, head_file, program, tmp_path):
    by_program = program_picture(program, tmp_path, head_file, "--size", "64x48", *options)
    assert_same(umbrick.render(head_file, layers=True, **SMALL, **keywords), by_program)


def test_fire_is_found_in_a_file_and_asked_for_of_a_volume(assets, program, tmp_path):
    path = assets / "densityAndHeat.vdb"
    by_program = program_picture(program, tmp_path, path, "--size", "64x48")
    assert by_program.scene["volume"]["emissionGrid"] == "heat"
    by_python = umbrick.render(path, layers=True, **SMALL)
    assert_same(by_python, by_program)
    assert by_python.chosen["emission_grid"] == "'heat'"
    of_volume = umbrick.render(umbrick.Volume.open(path, emission_grid="auto"), layers=True, **SMALL)
    np.testing.assert_array_equal(np.asarray(of_volume), np.asarray(by_program))
    assert "emissionGrid" not in umbrick.render(umbrick.Volume.open(path), **SMALL).scene["volume"]
    dark = umbrick.render(path, no_emission_light=True, **SMALL)
    assert np.asarray(dark)[..., :3].sum() < np.asarray(by_python)[..., :3].sum()
    with pytest.raises(umbrick.InvalidArgument, match="embers"):
        umbrick.Volume.open(path, emission_grid="embers")


def test_a_scene_makes_the_same_picture_in_any_form(head_file, program, tmp_path):
    scene = {
        "volume": {"file": str(head_file)},
        "camera": {"azimuth": 20, "size": [40, 40]},
        "transfer": {"points": [{"value": 500, "albedo": [0.8, 0.5, 0.4], "sigma_t": 0},
                                {"value": 1300, "albedo": [1, 1, 1], "sigma_t": 0.2}]},
        "model": "lights",
        "light": {"sources": [{"type": "directional", "direction": [1, 1, 1], "radiance": 2}]},
    }
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(scene))
    by_program = program_picture(program, tmp_path, path)
    by_python = umbrick.render(scene=scene, layers=True)
    assert_same(by_python, by_program)
    assert_same(umbrick.render(scene=path, layers=True), by_program)
    assert_same(umbrick.render(path, layers=True), by_program)
    # What a picture was made from makes it again, with arrays of NumPy in place of lists, too.
    again = by_python.scene
    again["camera"]["eye"] = np.array(again["camera"]["eye"])
    assert_same(umbrick.render(umbrick.Volume.open(head_file), again, layers=True), by_program)
    # Keywords change a scene as options do.
    program_turned = program_picture(program, tmp_path, path, "--azimuth", 50, "--window", 600, 1200)
    assert_same(umbrick.render(scene=scene, azimuth=50, window=(600, 1200), layers=True), program_turned)


def test_transfer_functions_are_dictionaries(head):
    tf = umbrick.tf_auto(head)
    plain = umbrick.render(head, **SMALL)
    np.testing.assert_array_equal(plain, umbrick.render(head, tf=tf, **SMALL))
    assert set(umbrick.tf_list()) >= {"ct-head", "ct-bone"}
    by_name = umbrick.render(head, tf="ct-head", **SMALL)
    np.testing.assert_array_equal(by_name, umbrick.render(head, tf=umbrick.tf_load("ct-head"), **SMALL))
    assert not np.array_equal(plain, by_name)


def test_arrays_share_the_memory_of_a_picture(head):
    picture = umbrick.render(head, layers=True, **SMALL)
    colour = picture.colour
    assert colour.shape == (48, 64, 4) and colour.dtype == np.float32 and picture.layers["Z"].shape == (48, 64)
    assert np.shares_memory(colour, picture.colour) and not colour.flags.owndata and not colour.flags.writeable
    kept = colour.copy()
    del picture
    np.testing.assert_array_equal(colour, kept)  # the array keeps the picture alive


# A bright voxel above the centre is seen in the upper half, where rows begin.
def test_row_0_is_at_the_top():
    array = np.zeros((9, 9, 9), np.float32)
    array[4, 4, 7] = 1
    array[4, 4, 0] = 0.01  # something below, so that the view is around both
    picture = umbrick.render(array, model="emission", view="front", up="z", size=(33, 33), backend="cpu")
    alpha = picture.colour[..., 3]
    assert alpha[:16].sum() > 10 * alpha[17:].sum() > 0


def test_files_of_pictures(head, tmp_path):
    picture = umbrick.render(head, layers=True, tf="ct-head", **SMALL)
    picture.save(tmp_path / "a.exr", exr_pixel="float")
    assert_same(umbrick.Picture.open(tmp_path / "a.exr"), picture)
    picture.save(tmp_path / "a.png", tone="filmic", exposure=1, annotate=["scale", "triad"], background="gradient")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    shown = picture._repr_png_()
    picture.save(tmp_path / "b.png")
    assert shown == (tmp_path / "b.png").read_bytes()
    pil = pytest.importorskip("PIL.Image")
    with pil.open(tmp_path / "b.png") as image:
        assert image.size == (64, 48)
        straight = np.asarray(image) / 255.0
    # 8 bits: half a step of alpha.
    np.testing.assert_allclose(straight[..., 3], picture.colour[..., 3], atol=0.5 / 255 + 1e-6)


@pytest.mark.parametrize("backend", ["cpu", "osmesa"])
def test_a_renderer_draws_again_without_upload(backend, head):
    renderer = umbrick.Renderer(head, tf="ct-head", model="cone", theta=40, backend=backend, **SMALL)
    first = renderer.render()
    for change in [dict(azimuth=80), dict(theta=20), dict(clip_planes=[(1, 0, 0, -100)]), dict(clip_planes=[]),
                   dict(zoom=0.8), dict(background="white"), dict(background=None)]:
        picture = renderer.set(**change).render()
        assert picture.stats["uploaded_bricks"] == 0
        assert not np.array_equal(picture, first) or change in (dict(clip_planes=[]),)
        # The picture is what a renderer of its own makes of the same scene.
        # On OpenGL its bricks may lie elsewhere in their textures, whose coordinates are single floats: at edges of bone
        # that moved pixels by 3e-4.
        fresh = umbrick.render(head, picture.scene, backend=backend)
        np.testing.assert_allclose(picture, fresh, rtol=0, atol=0 if backend == "cpu" else 2e-3)
    renderer.set_camera(azimuth=first.scene["camera"].get("azimuth", 30), zoom=1).set_theta(40).set_transfer("ct-bone")
    bone = renderer.render()
    renderer.set_transfer("ct-head").set_clip(box=((0, 0, 0), (100, 200, 200)))
    assert renderer.scene["clip"]["box"] == [[0, 0, 0], [100, 200, 200]]
    assert not np.array_equal(bone, renderer.render())
    before = renderer.scene
    with pytest.raises(umbrick.InvalidArgument):
        renderer.set(theta=95)
    assert renderer.scene == before


# One renderer is used by threads that did not make it, others are made by threads: each has a context of its own.
def test_threads_draw(head):
    shared = umbrick.Renderer(head, backend="osmesa", technique="slices", **SMALL)
    expected = np.asarray(shared.render())
    results = []

    def draw():
        mine = umbrick.render(head, backend="osmesa", technique="slices", **SMALL)
        results.append(np.array_equal(mine, expected) and np.array_equal(shared.render(), expected))

    threads = [threading.Thread(target=draw) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [True] * 3


def test_a_progressive_picture_knows_its_error(head):
    picture = umbrick.render(head, tf="ct-head", size=(32, 32), progressive=8, backend="cpu", seed=2)
    error = picture.error
    assert picture.stats["passes"] == 8 and 0 < error["statistical"] < error["total"] < 0.1
    assert error["total"] == pytest.approx(np.hypot(error["statistical"], error["systematic"]))
    assert umbrick.render(head, size=(8, 8)).error is None
    reached = umbrick.render(head, size=(16, 16), model="emission", target_error=0.2, backend="cpu")
    assert reached.error["reached_target"]


def test_pictures_keep_to_the_reference(head):
    words = dict(tf="ct-head", model="emission", size=(24, 24))
    truth = umbrick.reference(head, **words)
    measured = umbrick.compare(umbrick.render(head, backend="cpu", spacing=0.25, **words), truth)
    assert measured["rmse"] < 0.01 and measured["ssim"] > 0.99  # a tenth of what the scene shows
    paths = umbrick.reference(head, integrator="monte-carlo", paths=64, seed=5, **words)
    spread = umbrick.compare(paths, truth)["rmse"]
    assert spread < 2 * np.sqrt(np.mean(np.square(paths.layers["standardError"])))


def test_compare_is_numpys_arithmetic():
    rng = np.random.default_rng(3)
    a, b = rng.random((20, 30, 4)), rng.random((20, 30, 4))
    a[3, 7] += 5
    measured = umbrick.compare(a, b)
    difference = a.astype(np.float32).astype(float) - b.astype(np.float32)
    assert measured["rmse"] == pytest.approx(np.sqrt(np.mean(difference**2)))
    assert measured["max_error_pixel"] == (7, 3)
    assert measured["flip"] > 0.1 and umbrick.compare(a, a)["flip"] == 0
    assert umbrick.compare(a[..., 0], b[..., 0])["ssim"] is None
    with pytest.raises(umbrick.InvalidArgument) as error:
        umbrick.compare(a, b[:10])
    assert "30 x 20" in one_line(error) or "20" in one_line(error)


def test_check_proves_that_bricks_change_nothing():
    x = np.linspace(-1, 1, 10)
    ball = np.clip(1 - np.sqrt(x[:, None, None]**2 + x[:, None]**2 + x**2), 0, None)
    result = umbrick.check(ball, edges=[8], slices=1, size=(8, 8), backend="osmesa")
    assert result["passed"] and {row["invariant"] for row in result["invariants"]} == set(range(1, 9))


def test_study_is_its_record(tmp_path):
    path = tmp_path / "cube.vdb"
    umbrick.convert(np.pad(np.ones((6, 6, 6), np.float32), 2)).save(path)
    record = umbrick.study(path, tmp_path / "study", methods=["emission"], slices=[8, 16], segments=[1], bits=[(32, 32)],
                           sizes=[16], thetas=[40], repeats=1, reference_directions=4, backend="osmesa")
    assert record == json.loads((tmp_path / "study" / "study.json").read_text())
    assert len(record["cases"]) == 2
    with pytest.raises(umbrick.InvalidArgument) as error:
        umbrick.study(ramp(), tmp_path / "other")
    assert "a file" in one_line(error)


def test_an_empty_picture_says_why(head):
    with pytest.warns(umbrick.UmbrickWarning, match="nothing is drawn.*tf auto"):
        picture = umbrick.render(head, tf={"points": [{"value": 1e6, "albedo": [1, 1, 1], "sigma_t": 0},
                                                      {"value": 2e6, "albedo": [1, 1, 1], "sigma_t": 1}]}, **SMALL)
    assert picture.notes


def test_bad_scenes_are_one_clear_line(head, tmp_path):
    cases = [
        (dict(theta=95), ["theta", "95", "[0, 90)"]),
        (dict(theta="wide"), ["theta", "a number", "'wide'"]),
        (dict(model="cones"), ["model", "cone", "'cones'"]),
        (dict(size=(0, 10)), ["size", "0"]),
        (dict(size=10), ["size"]),
        (dict(tf="no-such"), ["no-such"]),
        (dict(tf={"points": [{"value": 1}]}), ["tf: points[0]"]),
        (dict(eye=(0, 0, 0)), ["eye needs look_at"]),
        (dict(eye=(0, 0, 0), look_at=(1, 1, 1), zoom=2), ["eye excludes view, azimuth"]),
        (dict(footprint=2, method="light-volume"), ["footprint", "method dos"]),
        (dict(mode="isosurface"), ["needs iso"]),
        (dict(iso=[1]), ["iso_colours", "mode isosurface"]),
        (dict(view="dorsal"), ["view", "'dorsal'"]),
        (dict(up="w"), ["up", "'w'"]),
        (dict(backend="metal"), ["backend", "'metal'"]),
        (dict(progressive=0), ["progressive", "0"]),
        (dict(no_culling=3), ["no_culling", "3"]),
        (dict(scene={"model": 7}), ["scene: model", "7"]),
        (dict(scene={"camera": {"sise": [1, 1]}}), ["scene: camera.sise", "did you mean 'size'"]),
        (dict(scene={"occlusion": {"theta": float("nan")}}), ["scene"]),
        (dict(scene=tmp_path / "none.json"), ["none.json"]),
        (dict(technique="shear-warp", backend="osmesa"), ["shear-warp"]),
    ]
    for keywords, words in cases:
        with pytest.raises(umbrick.Error) as error:
            umbrick.render(head, **{**SMALL, **keywords})
        for word in words:
            assert word in one_line(error)
        assert "--" not in str(error.value)
    with pytest.raises(TypeError, match="did you mean 'theta'"):
        umbrick.render(head, thet=3)
    with pytest.raises(umbrick.InvalidArgument, match="volume: expected"):
        umbrick.render()
    with pytest.raises(umbrick.InvalidArgument, match="nowhere.jpg"):
        umbrick.render(ramp(), size=(8, 8)).save(tmp_path / "nowhere.jpg")
