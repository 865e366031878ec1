# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""
How soon `view` shows a recorded run of 60 s at 1 kHz, and how smoothly it plays it.

Usage: python benchmarks/view.py [--rounds N] [--seconds S] [--angle NAME] [--output FILE]. Writes
view.md. The browser is a headless Chromium without a graphics card; where there is none, its
lines are left out. With `--angle gl-egl` or `--angle vulkan` it draws with the card.
"""

import argparse
from contextlib import contextmanager
import os
from pathlib import Path
import platform
import re
import statistics
import subprocess
import sys
import tempfile
import time


SIZES = {'desk': {'width': 1280, 'height': 760}, 'phone': {'width': 390, 'height': 844},
         'stamp': {'width': 300, 'height': 200}}
TICKS_PER_SECOND = os.sysconf('SC_CLK_TCK')
FRAMES = """seconds => new Promise(resolve => {
    const times = [];
    const next = now => {
        times.push(now);
        if (now - times[0] < 1000 * seconds) requestAnimationFrame(next); else resolve(times);
    };
    requestAnimationFrame(next);
})"""
# Watched for in the page: to be asked from without takes up to three pictures of the first ones.
DRAWN = """() => new Promise(done => {
    const next = () => {
        if (document.querySelector('canvas[data-engine]')
                && document.querySelector('.uplot canvas'))
            requestAnimationFrame(() => requestAnimationFrame(done));
        else requestAnimationFrame(next);
    };
    next();
})"""
HEAD = """\
# The viewer

`{command}` (two minutes): `view` of a run of {seconds:g} s at 1 kHz of the default scene,
{size:.0f} MB, {messages} messages, on {machine}, {date}. Load of the machine beside it: {load}.
Drawn by: {renderer}.

| from the command to | median s | least s | most s |
|---|---|---|---|
"""
COLUMNS = ('page', 'pictures a second', 'gap, 95 % [ms]', 'longest gap [ms]',
           'messages a second', 'kB a second', 'server [ms]', 'page [ms]', 'its scripts [ms]',
           'drawing [ms]')
ABOUT_SMOOTHNESS = """
Played at the speed of the run. The page is 1280 x 760 pixels, of the size of a phone, and of a
stamp. The last columns are CPU time for each picture: of the viewer, of the process of the page,
of the scripts in it, and of the process that draws.{about_software}

"""
ABOUT_SOFTWARE = """ In a browser without a graphics card, what
such a card does takes time on the same cores as all else. The scripts and the rest of the page fit
into the 33 ms between pictures that the viewer sends; the drawing does not."""
SOFTWARE = 'swiftshader'
ANGLES = {
    SOFTWARE: ('--use-angle=swiftshader', '--enable-unsafe-swiftshader'),
    'gl-egl': ('--use-gl=angle', '--use-angle=gl-egl', '--ignore-gpu-blocklist'),
    'vulkan': ('--use-gl=angle', '--use-angle=vulkan', '--enable-features=Vulkan',
               '--disable-vulkan-surface', '--ignore-gpu-blocklist')}
RENDERER = """() => {
    const gl = document.createElement('canvas').getContext('webgl2');
    return gl && gl.getParameter(
        gl.getExtension('WEBGL_debug_renderer_info').UNMASKED_RENDERER_WEBGL);
}"""


@contextmanager
def viewer(bag):
    """Run the viewer; give its process, and its URL once it tells it."""
    process = subprocess.Popen([sys.executable, '-m', 'dynsim_ros.cli.view', bag],
                               stdout=subprocess.PIPE, text=True, cwd=bag.parent)
    try:
        yield process, re.search('open ([^ ]+)', process.stdout.readline()).group(1)
    finally:
        process.terminate()
        process.wait()
        process.stdout.close()


def use_tests():
    """Let what the tests see pages with be imported."""
    sys.path.append(str(Path(__file__).resolve().parent.parent / 'test'))


def opened(bag):
    """Return the seconds to the URL and to the page with everything in it."""
    from page_client import PageClient

    begin = time.perf_counter()
    with viewer(bag) as (_, url):
        told = time.perf_counter() - begin
        page = PageClient(url)
        whole = time.perf_counter() - begin
        assert '/world/sphere/dark' in page.nodes and 'energies [J]' in page.controls
        page.close()
    return told, whole


def drawn(browser, bag):
    """Return the seconds to the first picture in a browser that is there already."""
    begin = time.perf_counter()
    with viewer(bag) as (_, url):
        page = browser.new_page(viewport=SIZES['desk'])
        page.goto(url)
        page.evaluate(DRAWN)
        seconds = time.perf_counter() - begin
        page.close()
    return seconds


def played(browser, process, url, size, shadows, seconds):
    """Play; return how smoothly that goes and what it costs, as named in COLUMNS."""
    got = []
    page = browser.new_page(viewport=size)
    page.on('websocket', lambda socket: socket.on(
        'framereceived', lambda data: got.append(len(data))))
    page.goto(url)
    page.get_by_role('button', name='Pause').wait_for()
    alert = page.get_by_role('alert').get_by_role('button')
    if alert.count():
        # The page says that there is no graphics card.
        alert.click()
    if shadows:
        page.get_by_role('checkbox', name='shadows').check()
    page.wait_for_timeout(3000)
    devtools = page.context.new_cdp_session(page)
    devtools.send('Performance.enable')
    got.clear()
    used, begin = costs(process.pid, devtools), time.perf_counter()
    times = page.evaluate(FRAMES, seconds)
    passed = time.perf_counter() - begin
    gaps = sorted(later - earlier for earlier, later in zip(times, times[1:]))
    spent = {kind: 1e3 * (cost - used[kind]) / len(gaps)
             for kind, cost in costs(process.pid, devtools).items()}
    page.close()
    return [1e3 * len(gaps) / (times[-1] - times[0]), gaps[int(0.95 * len(gaps))], gaps[-1],
            len(got) / passed, sum(got) / passed / 1e3,
            *map(spent.get, ('server', 'page', 'scripts', 'drawing'))]


def costs(server, devtools):
    """Return {'server', 'page', 'drawing': CPU time so far, 'scripts': of the page's [s]}."""
    metrics = devtools.send('Performance.getMetrics')['metrics']
    return {**cpu(server), 'scripts': next(
        metric['value'] for metric in metrics if metric['name'] == 'ScriptDuration')}


def cpu(server):
    """Return {'server', 'page' or 'drawing': CPU time so far [s]} of a server and browsers."""
    spent = {}
    for folder in Path('/proc').glob('[0-9]*'):
        try:
            command = (folder / 'cmdline').read_text()
            fields = (folder / 'stat').read_text().rpartition(')')[2].split()
        except OSError:
            continue
        kind = ('server' if int(folder.name) == server else
                'page' if '--type=renderer' in command else
                'drawing' if '--type=gpu-process' in command else None)
        if kind:
            spent[kind] = spent.get(kind, 0.0) + (
                int(fields[11]) + int(fields[12])) / TICKS_PER_SECOND
    return spent


def line(what, numbers):
    """Return a line of the table of seconds."""
    return (f'| {what} | {statistics.median(numbers):.2f} | {min(numbers):.2f} | '
            f'{max(numbers):.2f} |\n')


def smoothness(browser, bag, seconds, about):
    """Return the table of how it plays; about: what is told of it."""
    text = f'{about}| {" | ".join(COLUMNS)} |\n|{len(COLUMNS) * "---|"}\n'
    with viewer(bag) as (process, url):
        for name, size, shadows in (*((*part, False) for part in SIZES.items()),
                                    ('desk, with shadows', SIZES['desk'], True)):
            found = played(browser, process, url, size, shadows, seconds)
            text += f'| {name} | {" | ".join(f"{number:.0f}" for number in found)} |\n'
    return text


def renderer(browser):
    """Return what draws in a browser, as WebGL calls it."""
    page = browser.new_page()
    name = page.evaluate(RENDERER)
    page.close()
    return name


def measured(bag, rounds, seconds, angle):
    """Return both tables, and what drew."""
    opened(bag)
    told, whole = zip(*(opened(bag) for _ in range(rounds)))
    text = line('its address, in the terminal', told)
    text += line('the page, with all that is in it', whole)
    from chromium import chromium

    if chromium() is None:
        return text, 'nothing: there is no browser'
    from playwright.sync_api import sync_playwright

    about = ABOUT_SMOOTHNESS.format(about_software=ABOUT_SOFTWARE if angle == SOFTWARE else '')
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium(), args=['--no-sandbox', *ANGLES[angle]])
        drawn(browser, bag)
        text += line('the first picture in a browser',
                     [drawn(browser, bag) for _ in range(rounds)])
        text += smoothness(browser, bag, seconds, about)
        name = renderer(browser)
        browser.close()
    return text, name


def machine():
    """Return what this runs on."""
    found = re.search('model name\t: (.+)', Path('/proc/cpuinfo').read_text(encoding='utf-8'))
    name = found.group(1) if found else platform.machine()
    return f'{name}, {len(os.sched_getaffinity(0))} cores'


def main():
    """Measure, print and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--rounds', type=int, default=7)
    parser.add_argument('--seconds', type=float, default=10.0)
    parser.add_argument('--angle', choices=ANGLES, default=SOFTWARE,
                        help='what the browser draws with')
    parser.add_argument('--output', type=Path, default=Path(__file__).with_suffix('.md'))
    options = parser.parse_args()
    use_tests()
    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder, 'run.mcap')
        subprocess.run([sys.executable, '-m', 'dynsim_ros.cli.simulate', 'sphere_on_spring', '-q',
                        '--duration', '60', '--set', 'rate=1000', '--output', bag], check=True)
        load = os.getloadavg()[0]
        tables, drawer = measured(bag, options.rounds, options.seconds, options.angle)
        size = bag.stat().st_size / 1e6
    arguments = '' if options.angle == SOFTWARE else (
        f" ARGS='--angle {options.angle} --output FILE'")
    text = HEAD.format(command=f'make bench-view{arguments}', seconds=60, size=size,
                       messages='540 000', machine=machine(), date=time.strftime('%Y-%m-%d'),
                       load=f'{load:.1f}', renderer=drawer) + tables
    print(text, end='')
    options.output.write_text(text, encoding='utf-8')


if __name__ == '__main__':
    main()
