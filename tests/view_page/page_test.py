#!/usr/bin/env python3
"""Uses the page of `umbrick view` in headless Chromium as a person would: looks, drags, undoes, clips, compares, saves.

page_test.py ADDRESS [--folder FOLDER] [--screenshots FOLDER] [--patience SECONDS] [--only STEP ...]
ADDRESS is what `umbrick view` prints. FOLDER is where the server was started, where saved files are looked for. One
line is printed for each step. Exit status 0: all steps passed, 1: one failed, 77: there is no Chromium or no selenium.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import functools
import os
import shutil
import sys
import time

SKIPPED = 77
PATIENCE = 60  # seconds for a picture that is done, unless the caller says otherwise
# Root mean square difference of 8-bit channels, over means of some hundred pixels. Two pictures of one scene with
# errors of 0.01 differ by some tenths; a change that is seen anywhere in the picture makes one or more.
CHANGED = 1.0

try:
    from selenium import webdriver
    from selenium.common.exceptions import (NoSuchElementException, StaleElementReferenceException,
                                            WebDriverException)
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.chrome.service import Service
except ImportError:
    print("skipped: python3-selenium is not installed")
    sys.exit(SKIPPED)

# The picture as 64 x 64 pixels, RGBA over black.
PIXELS = """
const small = new OffscreenCanvas(64, 64), context = small.getContext("2d");
context.fillRect(0, 0, 64, 64);
context.drawImage(document.getElementById("picture"), 0, 0, 64, 64);
return Array.from(context.getImageData(0, 0, 64, 64).data);
"""
TYPE = """
const [input, value] = arguments;
input.focus();
input.value = value;
input.dispatchEvent(new Event("input", {bubbles: true}));
input.dispatchEvent(new Event("change", {bubbles: true}));
"""


def start_chromium(width, height):
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    driver = shutil.which("chromedriver")
    if not browser or not driver:
        print("skipped: chromium or chromedriver is not installed")
        sys.exit(SKIPPED)
    options = webdriver.ChromeOptions()
    options.binary_location = browser
    # A sandbox cannot be set up by root or in most containers, and /dev/shm may be small there.
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars",
                     f"--window-size={width},{height}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(driver), options=options)


class Page:
    def __init__(self, driver, address, screenshots, patience):
        self.driver, self.screenshots, self.patience, self.shots = driver, screenshots, patience, 0
        driver.get(address)

    def find(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def shot(self, name):
        if self.screenshots:
            self.shots += 1
            self.driver.save_screenshot(os.path.join(self.screenshots, f"{self.shots:02d}-{name}.png"))

    def wait(self, what, condition):
        until = time.monotonic() + self.patience
        while time.monotonic() < until:
            try:
                value = condition()
            except (NoSuchElementException, StaleElementReferenceException):
                value = None  # what is looked for may come, or is being replaced
            if value:
                return value
            time.sleep(0.05)
        self.shot("failed")
        status = self.find("#status").text
        lines = [line.text for line in self.driver.find_elements(By.CSS_SELECTOR, ".notice")]
        raise AssertionError(f"{what}: not within {self.patience} s; the status is '{status}', the notices {lines}")

    def pixels(self):
        return self.driver.execute_script(PIXELS)

    def frame(self):
        return int(self.find("#picture").get_attribute("data-frame") or -1)

    def at_rest(self):
        return (self.find("#picture").get_attribute("data-draft") == "false"
                and self.find("#status").get_attribute("data-draft") == "false")

    def picture_at_rest(self):
        """Waits until the server says that the picture is done, and no other one has come for half a second."""
        last, since = None, 0.0

        def settled():
            nonlocal last, since
            now = (self.frame(), self.at_rest(), self.find("#status").get_attribute("data-done"))
            if now != last:
                last, since = now, time.monotonic()
            return now[0] >= 0 and now[1:] == (True, "true") and time.monotonic() - since > 0.5
        self.wait("a picture that is done", settled)
        return self.pixels()

    def change(self, what, before):
        """Waits for a picture at rest that differs from `before`."""
        def changed():
            now = self.pixels()
            return self.at_rest() and difference(now, before) > CHANGED
        self.wait(f"{what} changes the picture", changed)
        return self.picture_at_rest()

    def drag(self, element, start, by, button_keys=()):
        """Drags from a place in CSS pixels from the element's upper left corner."""
        box = element.rect
        actions = ActionChains(self.driver, duration=50)
        for key in button_keys:
            actions.key_down(key)
        actions.move_to_element_with_offset(element, start[0] - box["width"] / 2, start[1] - box["height"] / 2)
        actions.click_and_hold()
        for _ in range(5):
            actions.move_by_offset(by[0] // 5, by[1] // 5)
        actions.release()
        for key in button_keys:
            actions.key_up(key)
        actions.perform()

    def field(self, path):
        return self.find(f'[data-path="{path}"] input.number').get_attribute("value")

    def labelled(self, label):
        return self.find(f'[aria-label="{label}"]')

    def unfold(self, title):
        for summary in self.driver.find_elements(By.CSS_SELECTOR, "#panel summary"):
            if summary.text == title and summary.find_element(By.XPATH, "..").get_attribute("open") is None:
                summary.click()
                time.sleep(0.3)  # what is in it is brought up to date when it has opened

    def select_in(self, selector, choice):
        select = self.find(selector)
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", select)
        for option in select.find_elements(By.TAG_NAME, "option"):
            if option.text == choice:
                option.click()
                return
        raise AssertionError(f"{selector} has no choice '{choice}'")

    def select(self, label, choice):
        name = self.driver.find_element(By.XPATH, f"//label[text()='{label}']").get_attribute("for")
        self.select_in(f"#{name}", choice)

    def press(self, text):
        """Presses a button, which may be replaced by its like, or come, meanwhile."""
        def pressed():
            for button in self.driver.find_elements(By.TAG_NAME, "button"):
                if button.text == text:
                    self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", button)
                    button.click()
                    return True
            return False
        self.wait(f"the button '{text}'", pressed)

    def keys(self, *keys):
        ActionChains(self.driver).send_keys_to_element(self.find("#picture"), *keys).perform()


def difference(a, b):
    """Of red, green and blue; the pixels' alpha is that of the small picture, which is opaque."""
    return (sum((x - y) ** 2 for x, y in zip(a, b)) / (len(a) * 3 / 4)) ** 0.5


def open_page(page):
    pixels = page.picture_at_rest()
    assert max(pixels[0::4]) > 20, "the first picture is black"
    page.shot("opened")


def drag_point(page):
    before = page.picture_at_rest()
    plot = page.find("#transfer")
    # What most of the volume is is faint: where it becomes dense, all of the picture changes.
    plot.send_keys(Keys.HOME, Keys.PAGE_DOWN, Keys.PAGE_DOWN)
    value = page.labelled("value").get_attribute("value")
    sigma_t = page.labelled("sigma_t").get_attribute("value")
    x, y = map(int, plot.get_attribute("data-chosen").split())
    page.drag(plot, (x, y), (0, 155 - y if y < 130 else 20 - y))  # to the foot of the plot, or to its top
    assert page.labelled("sigma_t").get_attribute("value") != sigma_t, "the point has not moved"
    page.change("a dragged point", before)
    page.shot("dragged")
    page.find("#undo").click()
    page.wait("undo brings the point back", lambda: page.labelled("value").get_attribute("value") == value
              and page.labelled("sigma_t").get_attribute("value") == sigma_t)
    page.wait("undo brings the picture back", lambda: page.at_rest() and difference(page.pixels(), before) < CHANGED)
    page.find("#redo").click()
    page.wait("redo moves the point again", lambda: page.labelled("sigma_t").get_attribute("value") != sigma_t)
    page.find("#undo").click()
    page.wait("undo once more", lambda: page.labelled("sigma_t").get_attribute("value") == sigma_t)


def add_and_remove_point(page):
    plot = page.find("#transfer")

    def count():
        shown = [p.text for p in page.driver.find_elements(By.CSS_SELECTOR, "#panel p[aria-live]") if p.is_displayed()]
        return int(shown[0].split()[-1])
    points = count()
    plot.send_keys(Keys.HOME, "n")
    page.wait("a point more", lambda: count() == points + 1)
    plot.send_keys(Keys.DELETE)
    page.wait("the point is gone", lambda: count() == points)


def move_camera(page):
    before = page.picture_at_rest()
    picture = page.find("#picture")
    middle = (picture.rect["width"] // 2, picture.rect["height"] // 2)
    page.unfold("Camera")
    azimuth = page.field("camera.azimuth")
    page.drag(picture, middle, (100, 20))
    page.wait("the azimuth changes", lambda: page.field("camera.azimuth") != azimuth)
    turned = page.change("turning", before)
    pan = page.field("camera.pan")
    page.drag(picture, middle, (50, 0), [Keys.SHIFT])
    page.wait("the pan changes", lambda: page.field("camera.pan") != pan)
    page.change("panning", turned)
    page.keys("1")
    page.wait("key 1 looks at the front", lambda: page.field("camera.azimuth") == "0")
    page.keys("w")
    page.wait("flying places the eye", lambda: page.find('[data-path="camera.eye"]').is_displayed())
    page.shot("flown")
    page.keys("r")
    page.wait("R goes back", lambda: page.find('[data-path="camera.azimuth"]').is_displayed()
              and page.field("camera.azimuth") == azimuth)
    page.wait("the first picture again", lambda: page.at_rest() and difference(page.pixels(), before) < CHANGED)


def zoom(page):
    before = page.picture_at_rest()
    page.driver.execute_script(
        "document.getElementById('picture').dispatchEvent(new WheelEvent('wheel', {deltaY: -200, cancelable: true,"
        " clientX: 200, clientY: 200}))")
    page.change("the wheel", before)
    page.keys("r")
    page.wait("R zooms back", lambda: page.at_rest() and difference(page.pixels(), before) < CHANGED)


def clip(page):
    before = page.picture_at_rest()
    page.unfold("Clipping")
    page.driver.find_element(By.XPATH, "//label[text()='clip box']/..//input").click()
    start = page.labelled("x from")
    page.wait("the box's faces appear", start.is_displayed)
    end = float(page.labelled("x to").get_attribute("value"))
    page.driver.execute_script(TYPE, start, str(end / 2))
    page.change("the clip box", before)
    page.shot("clipped")
    page.find("#undo").click()
    page.find("#undo").click()
    page.wait("undo takes the box away", lambda: not start.is_displayed())
    page.wait("the whole again", lambda: page.at_rest() and difference(page.pixels(), before) < CHANGED)


def clip_by_handle(page):
    """A face of the clip box is dragged in the picture, towards the face across from it."""
    before = page.picture_at_rest()
    page.unfold("Clipping")
    page.driver.find_element(By.XPATH, "//label[text()='clip box']/..//input").click()
    handle, other = page.find('#clip [data-face="z1"]'), page.find('#clip [data-face="z0"]')
    page.wait("handles appear", handle.is_displayed)
    value = float(page.labelled("z to").get_attribute("value"))
    a, b = handle.rect, other.rect
    page.drag(handle, (a["width"] / 2, a["height"] / 2),
              (int(0.35 * (b["x"] - a["x"])) // 5 * 5, int(0.35 * (b["y"] - a["y"])) // 5 * 5))
    page.wait("the face moves", lambda: float(page.labelled("z to").get_attribute("value")) < value)
    low = float(page.labelled("z from").get_attribute("value"))
    share = (value - float(page.labelled("z to").get_attribute("value"))) / (value - low)
    assert 0.2 < share < 0.5, f"the face went {share} of the way, and the pointer 0.35 in the picture"
    page.change("a dragged face", before)
    page.shot("clip-handles")
    page.find("#undo").click()
    page.find("#undo").click()
    page.wait("undo takes the box away", lambda: not handle.is_displayed())
    page.wait("the whole again", lambda: page.at_rest() and difference(page.pixels(), before) < CHANGED)


def shapes(page):
    """A function of value and gradient magnitude, as shapes that come back with undo."""
    before = page.picture_at_rest()
    page.select("function of", "value and gradient")
    plot = page.find("#shapes")
    said = page.driver.find_element(By.XPATH, "//canvas[@id='shapes']/following-sibling::p")
    page.wait("a first shape", lambda: said.text == "Shape 1 of 1, a rectangle")
    one = page.change("a function of gradients", before)
    page.shot("rectangle")
    x, y = map(int, plot.get_attribute("data-corners").split()[0].split(","))
    page.drag(plot, (x, y), (-60, 0))
    page.wait("a corner moves", lambda: int(plot.get_attribute("data-corners").split(",")[0]) < x - 40)
    page.change("a dragged corner", one)
    page.press("Add triangle")
    page.wait("two shapes", lambda: said.text == "Shape 2 of 2, a triangle")
    page.picture_at_rest()
    page.shot("triangle")
    page.find("#undo").click()
    page.wait("undo takes the triangle away", lambda: said.text == "Shape 1 of 1, a rectangle")
    page.find("#redo").click()
    page.wait("redo brings it back, a shape still", lambda: said.text == "Shape 2 of 2, a triangle")
    plot.send_keys(Keys.DELETE)
    page.wait("it is removed", lambda: said.text == "Shape 1 of 1, a rectangle")
    page.select("function of", "value")
    page.wait("the function of the value again", lambda: page.find("#transfer").is_displayed())
    page.wait("the first picture", lambda: page.at_rest() and difference(page.pixels(), before) < CHANGED)


def surfaces(page):
    """The value of an isosurface is a line over the histogram, which is dragged."""
    before = page.picture_at_rest()
    page.unfold("Mode")
    page.select_in('[data-path="mode"] select', "isosurface")
    plot = page.find("#surfaces")
    page.wait("a line over the histogram", lambda: plot.is_displayed() and plot.get_attribute("data-lines"))
    surface = page.change("a surface", before)
    page.shot("surface")
    x = int(plot.get_attribute("data-lines").split()[0])
    page.drag(plot, (x, 40), (50, 0))
    page.wait("the line moves", lambda: int(plot.get_attribute("data-lines").split()[0]) > x + 30)
    page.change("another value", surface)
    page.shot("surface-dragged")
    page.find("#undo").click()
    page.find("#undo").click()
    page.wait("undo brings the medium back", lambda: page.at_rest() and difference(page.pixels(), before) < CHANGED)


def compare(page):
    """The reference is computed beside the picture, and given up when the scene changes."""
    page.unfold("Against the reference")
    state = page.driver.find_element(By.XPATH, "//summary[text()='Against the reference']/..")
    page.press("Compare with reference")
    page.wait("it runs", lambda: state.get_attribute("data-state") == "running")
    page.wait("three pictures", lambda: state.get_attribute("data-state") == "done"
              and len(state.find_elements(By.CSS_SELECTOR, "figure img")) == 3)
    verdict = state.find_element(By.CSS_SELECTOR, ".verdict").text
    assert verdict.startswith("RMSE 0.0"), verdict
    page.driver.execute_script("arguments[0].scrollIntoView({block: 'end'})", state)
    page.shot("compared")
    state.find_element(By.CSS_SELECTOR, "figure button").click()
    page.wait("the pictures side by side", lambda: page.find("dialog.compared").is_displayed())
    page.shot("compared-large")
    page.find("dialog.compared button").click()
    page.press("Compare with reference")
    page.keys("1")
    page.wait("another scene ends it", lambda: state.get_attribute("data-state") == "none"
              and "the scene has changed" in state.text)
    page.keys("r")
    page.picture_at_rest()


def open_from_below(page, name):
    page.find("#open").click()
    entries = (By.CSS_SELECTOR, ".files button")
    page.wait("a listing", lambda: [each for each in page.driver.find_elements(*entries) if each.text == "below/"])
    page.shot("files")
    page.press("below/")
    page.wait("what is below", lambda: [each.text for each in page.driver.find_elements(*entries)]
              == ["ball.mha", "beat.nrrd"])
    page.press(name)


def open_files(page, folder):
    """Another volume keeps the page: from the folder of the server, and sent from this side."""
    if not folder or not os.path.isfile(os.path.join(folder, "below", "ball.mha")):
        return
    page.driver.execute_script("window.stayed = true")
    open_from_below(page, "ball.mha")
    page.wait("the other volume", lambda: "ball.mha" in page.driver.title)
    page.picture_at_rest()
    page.shot("other-volume")
    page.driver.find_element(By.CSS_SELECTOR, ".open-file input[type=file]").send_keys(
        os.path.join(folder, "sent", "box.mha"))
    page.wait("the volume that was sent", lambda: "box.mha" in page.driver.title)
    page.picture_at_rest()
    assert page.driver.execute_script("return window.stayed"), "the page was loaded anew"
    before = page.pixels()
    page.keys("5")
    page.change("a key", before)


def sequence(page, folder):
    """A file of several volumes has a bar: the slider and keys choose a frame, and play runs through all and begins anew."""
    bar = page.find("#sequence")
    assert not bar.is_displayed(), "a single volume has a bar of frames"
    if not folder or not os.path.isfile(os.path.join(folder, "below", "beat.nrrd")):
        return
    open_from_below(page, "beat.nrrd")
    page.wait("the bar", lambda: bar.is_displayed() and bar.get_attribute("data-number") == "0")
    first = page.picture_at_rest()
    slider = page.find('#sequence input[type="range"]')
    page.driver.execute_script(TYPE, slider, "4")
    page.wait("frame 4", lambda: page.find("#picture").get_attribute("data-number") == "4")
    larger = page.change("the slider", first)
    assert page.labelled("frame").get_attribute("value") == "4"
    page.shot("sequence")
    page.keys(",")
    page.wait("the frame before", lambda: page.find("#picture").get_attribute("data-number") == "3")
    page.change("the frame before", larger)
    seen = []

    def looped():
        """Several frames, and again one before them: a busy browser skips some."""
        seen.append(int(page.find("#picture").get_attribute("data-number")))
        return len(set(seen)) >= 3 and any(a > b for a, b in zip(seen, seen[1:]))
    page.driver.execute_script(TYPE, page.labelled("frames a second, at most"), "4")
    page.keys("p")
    page.wait("frames follow one another and begin anew", looped)
    assert bar.get_attribute("data-playing") == "true", "it plays no more"
    page.press("Stop")
    page.wait("it stops", lambda: bar.get_attribute("data-playing") == "false")
    page.picture_at_rest()
    assert page.find("#picture").get_attribute("data-number") == bar.get_attribute("data-number")


def light(page):
    before = page.picture_at_rest()
    page.unfold("Light")
    page.press("Add a light")
    page.wait("a ball appears", lambda: page.driver.find_elements(By.CSS_SELECTOR, ".ball"))
    lit = page.change("a light", before)
    ball = page.find(".ball")
    page.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", ball)
    page.drag(ball, (52, 52), (-30, 10))
    page.change("another direction", lit)
    page.shot("lit")
    page.press("Remove light")
    page.wait("no ball is left", lambda: not page.driver.find_elements(By.CSS_SELECTOR, ".ball"))


def probe(page):
    ActionChains(page.driver).move_to_element(page.find("#picture")).perform()
    page.wait("the pointer's value", lambda: page.find("#probe").text.startswith(("value", "nothing")))


def pause(page):
    page.keys(" ")
    page.wait("paused", lambda: page.find("#pause").text == "Go on")
    page.keys(" ")
    page.wait("going on", lambda: page.find("#pause").text == "Pause")


def save(page, folder):
    page.unfold("Save and share")
    for button, name in (("Save picture", "picture.png"), ("Save scene", "scene.json")):
        page.press(button)
        page.wait(f"{name} is saved", lambda: any(
            line.text.startswith("Saved") and name in line.text
            for line in page.driver.find_elements(By.CSS_SELECTOR, ".notice")))
        if folder:
            path = os.path.join(folder, name)
            assert os.path.isfile(path) and os.path.getsize(path) > 0, f"{path} is not there"


def refuse(page):
    """An edit that the server refuses is said in one line, and the page shows again what the server has."""
    page.unfold("Sampling")
    spacing = page.field("sampling.spacing")
    page.driver.execute_script(TYPE, page.find('[data-path="sampling.spacing"] input.number'), "-1")
    page.wait("an error's line", lambda: page.driver.find_elements(By.CSS_SELECTOR, ".notice.error"))
    page.find("#picture").click()
    page.wait("the value before", lambda: page.field("sampling.spacing") == spacing)
    page.find(".notice.error button").click()


def help_list(page):
    page.keys("?")
    page.wait("the list of keys", lambda: page.find("dialog.help").is_displayed())
    page.shot("keys")
    ActionChains(page.driver).send_keys(Keys.ESCAPE).perform()
    page.wait("it closes", lambda: not page.find("dialog.help").is_displayed())


def narrow(page):
    """The page fits a small window and a phone: nothing has to be scrolled sideways."""
    for width, height in ((1024, 640), (500, 900)):
        page.driver.set_window_size(width, height)
        page.wait("the picture takes the window's size", lambda: page.find("#picture").rect["width"] <= width)
        page.picture_at_rest()
        size = "const c = document.getElementById('picture'); return [c.width, c.height]"
        rest = page.driver.execute_script(size)
        for _ in range(4):  # the words below the picture must not change its size
            time.sleep(0.5)
            assert page.driver.execute_script(size) == rest, "the picture at rest changes its size"
        fits = page.driver.execute_script("return document.documentElement.scrollWidth <= innerWidth")
        assert fits, f"a window of {width} x {height} has to be scrolled sideways"
        page.shot(f"{width}x{height}")


def no_console_errors(page):
    # A refused edit is no error of the page and is not in the console.
    errors = [entry["message"] for entry in page.driver.get_log("browser") if entry["level"] == "SEVERE"]
    assert not errors, errors


def name_of(step):
    return getattr(step, "func", step).__name__


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address")
    parser.add_argument("--folder")
    parser.add_argument("--screenshots")
    parser.add_argument("--patience", type=float, default=PATIENCE)
    parser.add_argument("--only", nargs="+", help="these steps, besides the first")
    arguments = parser.parse_args()
    try:
        driver = start_chromium(1000, 700)
    except WebDriverException as error:
        print(f"skipped: Chromium does not start: {error.msg.splitlines()[0]}")
        return SKIPPED
    steps = [open_page, drag_point, add_and_remove_point, move_camera, zoom, clip, clip_by_handle, shapes, surfaces,
             light, probe, pause, compare, functools.partial(save, folder=arguments.folder), refuse, help_list,
             functools.partial(open_files, folder=arguments.folder),
             functools.partial(sequence, folder=arguments.folder), narrow, no_console_errors]
    if arguments.only:
        steps = [step for step in steps if name_of(step) in ["open_page", *arguments.only]]
    try:
        try:
            page = Page(driver, arguments.address, arguments.screenshots, arguments.patience)
        except WebDriverException as error:
            print(f"failed: {arguments.address} cannot be opened: {error.msg.splitlines()[0]}")
            return 1
        for step in steps:
            name = name_of(step)
            began = time.monotonic()
            try:
                step(page)
            except (AssertionError, WebDriverException) as error:
                page.shot("failed")
                print(f"failed: {name}: {str(error).splitlines()[0]}")
                return 1
            print(f"passed: {name} ({time.monotonic() - began:.1f} s)", flush=True)
    finally:
        driver.quit()
    return 0


if __name__ == "__main__":
    sys.exit(main())
