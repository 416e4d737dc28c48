# Work that takes long: progress, callbacks that raise, Ctrl+C, other threads of the interpreter.
# SPDX-License-Identifier: Apache-2.0
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import umbrick
from conftest import one_line

LONG = dict(tf="ct-head", model="cone", size=(1024, 1024), quality="high", samples=64)


class Enough(Exception):
    pass


def test_progress_rises_and_names_its_step(head):
    told = []
    umbrick.render(head, size=(256, 256), samples=4, backend="cpu", progress=lambda share, step: told.append((share, step)))
    assert all(0 <= share <= 1 and step for share, step in told)


@pytest.mark.parametrize("work", [
    lambda head, progress: umbrick.render(head, backend="cpu", progress=progress, **LONG),
    lambda head, progress: umbrick.render(head, backend="osmesa", progress=progress, **LONG),
    lambda head, progress: umbrick.render(head, progressive=1000, progress=progress, **LONG),
    lambda head, progress: umbrick.reference(head, size=(1024, 1024), tf="ct-head", progress=progress),
    lambda head, progress: umbrick.check(head, progress=progress),
])
def test_what_a_callback_raises_ends_the_work(work, head):
    def progress(share, step):
        raise Enough(step)

    with pytest.raises(Enough):
        work(head, progress)


def test_a_renderer_goes_on_after_it_was_stopped(head):
    renderer = umbrick.Renderer(head, tf="ct-head", size=(64, 64), backend="osmesa")
    expected = np.asarray(renderer.render())
    renderer.set(size=(1024, 1024), samples=64)

    def progress(share, step):
        raise Enough

    with pytest.raises(Enough):
        renderer.render(progress=progress)
    renderer.set(size=(64, 64), samples=1)
    np.testing.assert_array_equal(renderer.render(), expected)


def test_a_callback_cannot_draw_with_the_renderer_that_calls_it(head):
    renderer = umbrick.Renderer(head, tf="ct-head", size=(1024, 1024), samples=64, backend="cpu")
    with pytest.raises(umbrick.InvalidArgument) as error:
        renderer.render(progress=lambda share, step: renderer.render())
    assert "progress" in one_line(error)


INTERRUPTED = """
import signal, numpy as np, umbrick
signal.signal(signal.SIGINT, signal.default_int_handler)  # whoever started this may ignore it
volume = umbrick.Volume.open(np.random.default_rng(1).random((96, 96, 96), np.float32))
print("ready", flush=True)
try:
    {work}
    print("done")
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


# The limit of 10 s is no measure of speed: the work itself takes minutes.
@pytest.mark.parametrize("work", [
    "umbrick.render(volume, size=(2048, 2048), samples=256, quality='high', backend='cpu')",
    "umbrick.render(volume, size=(2048, 2048), samples=256, quality='high', backend='osmesa')",
    "umbrick.reference(volume, size=(2048, 2048))",
])
def test_ctrl_c_ends_the_work(work):
    with subprocess.Popen([sys.executable, "-c", INTERRUPTED.format(work=work)], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "ready\n"
        time.sleep(0.3)
        child.send_signal(signal.SIGINT)
        try:
            assert child.communicate(timeout=10)[0] == "interrupted\n"
        finally:
            child.kill()


def test_other_threads_run_meanwhile(head):
    counted = 0
    stop = threading.Event()

    def count():
        nonlocal counted
        while not stop.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    started = counted
    # A render that never gave the lock away would leave no turn to the other thread until it is over.
    picture = umbrick.render(head, tf="ct-head", size=(400, 400), backend="cpu", samples=4)
    turns = counted - started
    stop.set()
    thread.join()
    assert turns > 5 or picture.stats["ms"] < 50
