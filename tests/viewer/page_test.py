"""The page of `ossa view` in a headless Chromium. With --pictures FOLDER the pictures of docs/viewer.md are
written there; without, beside the test."""
import json
import pathlib
import shutil
import sys
import time
import unittest
import urllib.request

import browser
from browser import CLIP, WORK, Command, Keys, Page, numpy

PICTURES = WORK / "pictures"
CAMERA = f"openni:ossa://{CLIP}?loop=1"
# A colour of the palette is on the screen as it was sent, but for edges that are smoothed.
LEAST_LIKENESS = 40
PERSON_1 = (0x56, 0xb4, 0xe9)
BACKGROUND = (0x14, 0x16, 0x1a)  # of the dark page


def near_colour(picture, colour, x, y, radius):
    """Whether a pixel around x, y has about that colour."""
    part = picture[max(0, y - radius):y + radius + 1, max(0, x - radius):x + radius + 1]
    return bool((abs(part - numpy.array(colour)).max(axis=2) < LEAST_LIKENESS).any())


def share_of_other_colours(picture):
    """The share of pixels that are not the background: 0 of a blank canvas."""
    return float((picture != numpy.array(BACKGROUND)).any(axis=2).mean())


def wait_for_file(path):
    until = time.monotonic() + browser.PATIENCE_S
    while not path.exists():
        assert time.monotonic() < until, f"{path} did not appear"
        time.sleep(0.05)


class InBrowser(unittest.TestCase):
    driver = None  # one for all: starting one takes seconds

    def serve(self, *arguments, port=0):
        command = Command(*arguments, port=port)
        self.addCleanup(command.end)
        return command

    def open(self, command):
        self.addCleanup(self.driver.get, "about:blank")  # before its command ends: a page says that it lost it
        self.page = Page(self.driver, command.url)
        self.page.run("page.theme('dark')")  # also kept, where the browser keeps anything
        return self.page

    def tearDown(self):
        self.assertEqual([entry["message"] for entry in self.page.console_errors()], [])


class RecordingPage(InBrowser):
    @classmethod
    def setUpClass(cls):
        cls.command = Command("view", CLIP, "--over", CLIP / "truth.jsonl")
        cls.addClassCleanup(cls.command.end)

    def setUp(self):
        page = self.open(self.command)
        page.wait("return page.state.complete && page.track.length === page.state.frames"
                  " && page.overlays[0].length > 0", "the whole recording")
        page.click("#play")  # now it stands
        page.run("page.jump(0)")
        page.wait_for_frame(0)

    def test_scrubbing_shows_the_chosen_frame(self):
        page, frames = self.page, self.page.run("return page.total")
        left, top, width, height = page.box("#strip")
        for frame in (17, 3, frames - 1):
            x = left + (frame + 0.5) / frames * width
            mouse = browser.webdriver.ActionChains(self.driver)
            strip = self.driver.find_element("css selector", "#strip")
            mouse.move_to_element_with_offset(strip, round(x - left - width / 2), 0).click().perform()
            page.wait_for_frame(frame)
            # Picture and skeletons are of that frame: the files say which those are.
            truth = json.loads((CLIP / "truth.jsonl").read_text().splitlines()[frame])
            shown = page.run("return page.overlays[0].at(page.frame.layers.final.time_s).bodies.get(1).Head.p")
            self.assertEqual(shown, truth["bodies"][0]["joints"]["Head"]["p"])
            depth = numpy.array(browser.Image.open(sorted((CLIP / "depth").iterdir())[frame]))
            self.assertEqual(page.run("return [...page.frame.depth.slice(0, 60000)]"),
                             list(depth.astype("<u2").tobytes()[:60000]))

    def test_joints_are_drawn_at_their_projection(self):
        page = self.page
        page.run("page.jump(12)")
        page.wait_for_frame(12)
        page.click("[data-view=camera]")
        page.click("[data-layer=cloud]")  # nothing else has a person's colour
        self.assertGreater(share_of_other_colours(page.picture_of("#stage")), 0.01)
        camera, joints = page.run("return [page.frame.camera, page.frame.layers.final.bodies[0].joints]")
        picture = page.picture_of("#stage")
        height, width = picture.shape[:2]
        scale = min(width / camera["width"], height / camera["height"])
        for name in ("HandRight", "KneeLeft", "HipCenter"):
            x, y, z = joints[name]["p"]
            u, v = camera["cx"] - camera["fx"] * x / z, camera["cy"] - camera["fy"] * y / z
            at = width / 2 + (u - camera["width"] / 2) * scale, height / 2 + (v - camera["height"] / 2) * scale
            self.assertTrue(near_colour(picture, PERSON_1, *map(round, at), 2), f"{name} at {at}")
            self.assertFalse(near_colour(picture, PERSON_1, round(at[0]) + 150, round(at[1]), 2), "nobody is there")

    def test_layers_can_be_switched(self):
        page = self.page
        page.run("page.jump(12)")
        page.wait_for_frame(12)
        with_points = share_of_other_colours(page.picture_of("#stage"))
        page.press("p")
        without = share_of_other_colours(page.picture_of("#stage"))
        self.assertGreater(with_points, without + 0.2)
        for key, layer in (("s", "final"), ("r", "refined"), ("w", "raw"), ("m", "mesh"), ("f", "floor"), ("l", "trails")):
            before = page.picture_of("#stage")
            page.press(key)
            changed = (page.picture_of("#stage") != before).any()
            self.assertTrue(changed, f"{layer} is to be seen, or not any more")
        page.press("p")
        seen = set()
        for _ in range(3):
            page.press("c")
            seen.add(page.picture_of("#stage").tobytes())
        self.assertEqual(len(seen), 3, "by depth, person and part")

    def test_fitted_body_covers_the_pixels_of_its_person(self):
        page = self.page
        page.run("page.jump(12)")
        page.wait_for_frame(12)
        page.wait("return page.scene.meshes.triangles && page.scene.meshes.triangles.count === 3 * 4000", "its triangles")
        camera, (mesh,), mask = page.run(
            "const m = page.frame; return [m.camera, m.meshes.map(one => ({id: one.id, corners: [...one.corners]})), [...m.users]]")
        corners = numpy.array(mesh["corners"]).reshape(-1, 3)
        u = numpy.round(camera["cx"] - camera["fx"] * corners[:, 0] / corners[:, 2]).astype(int)
        v = numpy.round(camera["cy"] - camera["fy"] * corners[:, 1] / corners[:, 2]).astype(int)
        users = numpy.array(mask).reshape(camera["height"], camera["width"])
        inside = (u >= 0) & (u < camera["width"]) & (v >= 0) & (v < camera["height"])
        self.assertGreater((users[v[inside], u[inside]] == mesh["id"]).mean(), 0.7, "its corners lie on the person's pixels")
        page.click("[data-view=camera]")
        for name in ("cloud", "final", "floor"):
            page.click(f"[data-layer={name}]")
        nothing = page.picture_of("#stage")
        page.press("m")
        body = (page.picture_of("#stage") != nothing).any(axis=2)
        self.assertGreater(body.sum(), 1000)

    def test_click_shows_the_worst_frames(self):
        page = self.page
        page.wait("return document.querySelectorAll('#worst button').length > 0", "worst frames")
        self.assertIn("cm", page.run("return document.querySelector('#worst button').innerText"))
        frame = int(page.run("return document.querySelector('#worst button').innerText.match(/frame (\\d+)/)[1]"))
        page.run("document.querySelector('#worst button').click()")
        page.wait_for_frame(frame)
        for quantity in ("left elbow", "speed", "error", "confidence"):
            page.run("const q = document.getElementById('quantity'); q.value = arguments[0]; q.onchange()", quantity)
            self.assertRegex(page.run("return document.getElementById('value').innerText"), r"\d", quantity)

    def test_curves_of_hours_are_drawn(self):
        error = self.driver.execute_async_script("""
            const done = arguments[0], hours = new Array(400000).fill(1.5);
            import('/page/charts.js').then(charts => {
              charts.drawCurves(document.getElementById('curves'), [hours], ['red'], hours.length, 0, 'm');
              done(null);
            }).catch(error => done(error.message));""")
        self.assertIsNone(error)

    def test_plays_pauses_and_steps(self):
        page = self.page
        page.press(".")
        page.wait_for_frame(1)
        page.press(",")
        page.wait_for_frame(0)
        page.press(" ")
        page.wait("return page.frame.number > 3", "it plays")
        page.press(" ")
        self.assertFalse(page.run("return page.player.playing"))
        page.press("?")
        self.assertIn("play, pause", page.run("return document.getElementById('keys').innerText"))

    def test_shown_frame_stays_when_the_connection_is_lost(self):
        page = self.page
        page.run("page.jump(12)")
        page.wait_for_frame(12)
        page.run("page.player.connection.socket.close()")
        page.wait("return document.getElementById('status').textContent === 'no connection'", "the lost connection is shown")
        page.wait("return document.getElementById('status').textContent.startsWith('frame ')", "it is back")
        self.assertEqual(page.run("return page.frame.number"), 12)

    def test_chosen_person_stays_chosen_when_others_come_and_go(self):
        chosen = self.driver.execute_async_script("""
            const done = arguments[0];
            import('/page/panels.js').then(({fillSelect}) => {
              const select = document.createElement('select'), chosen = [];
              for (const names of [['1', '2'], ['1', '2', '3'], ['2', '3'], ['3', '4']]) {
                fillSelect(select, names);
                if (names.length === 2 && names[0] === '1') select.value = '2';
                chosen.push(select.value);
              }
              done(chosen);
            }).catch(error => done(error.message));""")
        self.assertEqual(chosen, ["2", "2", "2", "3"])

    def test_button_says_play_again_at_the_end(self):
        page = self.page
        page.click("#loop")
        page.run("page.jump(page.total - 2)")
        page.click("#play")
        self.assertEqual(page.run("return document.getElementById('play').ariaLabel"), "pause")
        page.wait("return !page.player.playing", "the end")
        self.assertEqual(page.run("return document.getElementById('play').ariaLabel"), "play")

    def focus_by_tab(self, before, selector):
        """Tab from the element before it."""
        self.page.run("document.querySelector(arguments[0]).focus()", before)
        self.page.send(Keys.TAB)
        self.assertTrue(self.page.run("return document.activeElement.matches(arguments[0])", selector), selector)

    def test_space_presses_the_button_focused_by_tab(self):
        page = self.page
        self.focus_by_tab("[data-view=orbit]", "[data-view=camera]")
        page.send(" ")
        self.assertEqual(page.run("return document.querySelector('#views [aria-pressed=true]').innerText"), "camera")
        self.assertFalse(page.run("return page.player.playing"))
        page.click("[data-view=top]")
        page.send(" ")
        self.assertTrue(page.run("return page.player.playing"), "after a click it plays")

    def test_keys_work_after_a_click_on_a_checkbox(self):
        page = self.page
        page.click("[data-layer=trails]")
        page.send(".")
        page.wait_for_frame(1)

    def test_screen_reader_gets_labels_and_people_but_not_every_frame(self):
        page = self.page
        nameless = ("return [...document.querySelectorAll('button, canvas')]"
                    ".filter(e => !/[a-z]/.test(e.ariaLabel ?? e.textContent)).length")
        self.assertEqual(page.run(nameless), 0)
        self.assertEqual(page.run("return document.getElementById('play').ariaLabel"), "play")
        page.run("window.heard = 0; new MutationObserver(all => { heard += all.length; }).observe("
                 "document.querySelector('[role=status]'), {childList: true, characterData: true, subtree: true})")
        for frame in (1, 2, 3):
            page.press(".")
            page.wait_for_frame(frame)
        self.assertEqual(page.run("return [heard, document.querySelector('[role=status]').textContent]"), [0, "1 person"])
        self.assertRegex(page.run("return document.getElementById('strip').getAttribute('aria-valuetext')"), "frame 3 of")

    def test_selected_span_is_saved(self):
        page, downloads = self.page, WORK / "downloads"
        page.run("document.getElementById('export_panel').open = true;"
                 "document.getElementById('from').value = 2; document.getElementById('to').value = 9")
        for name in ("skeletons.jsonl", "skeletons.bvh", "skeletons.csv", "skeletons.glb", "frames_2_9.png"):
            page.click("#strip_png" if name.endswith("png") else f"[data-export={name.split('.')[1]}]")
            wait_for_file(downloads / name)
        self.assertEqual(len((downloads / "skeletons.jsonl").read_text().splitlines()), 8)
        glb = (downloads / "skeletons.glb").read_bytes()
        length = int.from_bytes(glb[12:16], "little")
        scene = json.loads(glb[20:20 + length])
        self.assertEqual(glb[:4], b"glTF")
        self.assertEqual((len(scene["skins"]), len(scene["meshes"])), (1, 1), "a person in their skin")

    def test_changed_settings_track_the_recording_again(self):
        page = self.page
        page.run("page.settings.inputs.find(i => i.dataset.setting === 'method').value = 'holt';"
                 "page.settings.inputs.find(i => i.dataset.setting === 'method').onchange()")
        page.wait("return page.state.generation === 1 && page.state.complete", "it was tracked again")
        self.assertEqual(page.run("return page.state.settings.method"), "holt")
        page.run("page.player.send({settings: {method: 'best'}}); page.player.send({settings: {users: 5}});")
        page.wait("return page.state.complete && page.state.settings.method === 'best' && page.state.settings.users === 5",
                  "two that were told at once")
        page.run("page.player.send({settings: {users: 6}})")
        page.wait("return page.state.complete && page.state.settings.users === 6", "and again")

    def test_pictures_of_the_documentation_are_drawn(self):
        page = self.page
        self.driver.set_window_size(1280, 1060)
        self.addCleanup(self.driver.set_window_size, *browser.WINDOW)
        page.run("page.jump(19)")
        page.wait_for_frame(19)
        page.click("[data-layer=trails]")
        page.press("m")
        page.click("#live summary")
        page.save("viewer_recording.png", PICTURES)
        page.click("#theme")
        page.click("[data-view=side]")
        page.run("document.getElementById('colour').value = 2; document.getElementById('colour').onchange()")
        page.save("viewer_side.png", PICTURES)


class CameraPage(InBrowser):
    def test_camera_is_shown_live_and_recorded(self):
        page = self.open(self.serve("view", CAMERA, "--record-to", WORK))
        self.assertFalse(page.run("return page.state.kept"))
        first = page.run("return page.frame.number")
        page.wait(f"return page.frame.number > {first + 3}", "frames go on")
        self.assertGreater(share_of_other_colours(page.picture_of("#stage")), 0.1)
        self.assertRegex(page.run("return document.getElementById('flow').innerText"), r"dropped, latency \d+ ms")
        page.click("#record")
        page.wait("return page.state.recording.status", "it records")
        before = page.run("return page.frame.number")
        page.wait(f"return page.frame.number > {before + 3}", "frames go on")
        page.click("#record")
        page.wait("return !page.state.recording.on", "it records no more")
        name = page.run("return page.state.recording.status")
        wait_for_file(WORK / name)

    def test_page_fits_a_phone(self):
        self.driver.set_window_size(420, 860)
        self.addCleanup(self.driver.set_window_size, *browser.WINDOW)
        page = self.open(self.serve("view", CAMERA))
        self.assertLessEqual(page.run("return document.documentElement.scrollWidth - innerWidth"), 0, "nothing sticks out")
        self.assertEqual(page.run("return page.frame.step"), 2, "fewer pixels")
        self.assertEqual(page.run("return document.getElementById('name').innerText"), "one", "its name alone")
        page.wait("return page.frame.layers.final.bodies.length > 0 && page.frame.parts.some(part => part > 0)",
                  "somebody, and the parts")
        page.save("viewer_phone.png", PICTURES)


    def test_reconnects_after_a_connection_that_never_opened(self):
        page = self.open(self.serve("view", CAMERA))
        page.run("""
            const Real = WebSocket;
            let failing = 2;  // as those to a machine that is off: nothing for seconds, then closed
            window.WebSocket = class {
              static OPEN = Real.OPEN;
              constructor(url) {
                if (failing-- <= 0) return new Real(url);
                setTimeout(() => { this.readyState = Real.CLOSED; this.onclose(); }, 1500);
              }
            };
            page.player.connection.socket.close();""")
        page.wait("return document.getElementById('status').textContent === 'no connection'", "the lost connection is shown")
        lost = page.run("return page.frame.number")
        page.wait(f"return page.frame.number > {lost}", "it goes on")


class BrowserWithoutLocalStorage(InBrowser):
    def test_page_works_without_local_storage(self):
        script = "Object.defineProperty(window, 'localStorage', {get() { throw new DOMException('denied', 'SecurityError'); }})"
        added = self.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": script})
        self.addCleanup(self.driver.execute_cdp_cmd, "Page.removeScriptToEvaluateOnNewDocument", added)
        self.open(self.serve("view", CLIP / "truth.jsonl"))
        self.assertIn("person", self.page.run("return document.getElementById('status').textContent"))


class PhysicsPage(InBrowser):
    def test_character_is_drawn_at_its_person(self):
        page = self.open(self.serve("view", CLIP, "--physics", "on"))
        page.wait("return page.state.complete && page.track.length === page.state.frames", "the whole recording")
        page.click("#play")
        page.run("page.jump(12)")
        page.wait_for_frame(12)
        solids, joints = page.run("return [page.frame.solids, page.frame.layers.final.bodies[0].joints]")
        self.assertEqual([solid["shape"] for solid in solids], ["capsule"] * 19)
        thigh = numpy.array(joints["HipLeft"]["p"]) / 2 + numpy.array(joints["KneeLeft"]["p"]) / 2
        gap_m = min(numpy.abs(numpy.array(solid["at"]) - thigh).max() for solid in solids)
        self.assertLess(gap_m, 0.05, "a capsule around the thigh")
        for name in ("cloud", "final", "frustum"):
            page.click(f"[data-layer={name}]")
        page.click("[data-view=follow]")
        page.save("viewer_physics.png", PICTURES)
        before = page.picture_of("#stage")
        page.press("b")
        self.assertGreater((page.picture_of("#stage") != before).any(axis=2).sum(), 1000, "its capsules are to be seen")


class SkeletonFilePage(InBrowser):
    def test_view_follows_the_chosen_person(self):
        lines = [json.loads(line) for line in (CLIP / "truth.jsonl").read_text().splitlines()]
        for line in lines:
            (first,) = line["bodies"]
            second = {"id": 2, "joints": {name: {"p": [x - 1, y, z]} for name, (x, y, z) in
                                          ((name, joint["p"]) for name, joint in first["joints"].items())}}
            line["bodies"].append(second)
        (WORK / "two.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
        page = self.open(self.serve("view", WORK / "two.jsonl"))
        page.wait("return document.getElementById('person').length === 2", "both people")
        page.run("page.jump(0)")
        page.wait_for_frame(0)
        page.click("[data-view=follow]")
        page.run("const choice = document.getElementById('person'); choice.value = '2'; choice.onchange(); page.jump(1)")
        page.wait_for_frame(1)
        x, _, _ = lines[1]["bodies"][1]["joints"]["Spine"]["p"]
        self.assertAlmostEqual(page.run("return page.scene.controls.target.x"), x, delta=0.05)

    def test_skeletons_are_shown_without_images(self):
        page = self.open(self.serve("view", CLIP / "truth.jsonl"))
        self.assertTrue(page.run("return document.getElementById('pictures').hidden"))
        self.assertGreater(share_of_other_colours(page.picture_of("#stage")), 0.01)


    def test_open_page_shows_the_next_run(self):
        before = self.serve("view", CLIP)
        page = self.open(before)
        page.wait("return page.track.length > 0", "tracks")
        before.end()
        page.wait("return document.getElementById('status').textContent === 'no connection'", "the lost connection is shown")
        self.serve("view", CLIP / "truth.jsonl", port=before.url.rstrip("/").split(":")[-1])
        page.wait("return window.page && document.title === 'truth.jsonl - ossa' && page.track.length > 0", "the file")
        page.console_errors()  # of the connection


class OtherMachines(InBrowser):
    def test_token_opens_the_page_to_other_machines(self):
        command = self.serve("view", CLIP / "truth.jsonl", "--listen", "0.0.0.0")
        page = self.open(command)
        self.assertIn("token=", command.url)
        with self.assertRaises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(command.url.split("?")[0])
        self.assertEqual(refused.exception.code, 401)
        page.wait("return page.frame", "a frame, by the cookie")


if __name__ == "__main__":
    if "--pictures" in sys.argv:
        at = sys.argv.index("--pictures")
        PICTURES = pathlib.Path(sys.argv[at + 1]).resolve()
        del sys.argv[at:at + 2]
    shutil.rmtree(WORK, ignore_errors=True)
    (WORK / "downloads").mkdir(parents=True)
    InBrowser.driver = browser.start_browser()
    try:
        unittest.main()
    finally:
        InBrowser.driver.quit()
