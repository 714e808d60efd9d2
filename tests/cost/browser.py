"""Headless Chromium for tests: pages in frames of given widths, measured by a script of ours; screenshots. No network: whatever is asked for lands at a proxy of ours that notes it."""
import html
import http.server
import json
import os
import pathlib
import re
import struct
import subprocess
import tempfile
import threading
import zlib

SECONDS = 60
QUIET = ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--disable-default-apps", "--disable-extensions", "--disable-dev-shm-usage", "--enable-logging=stderr", "--v=0"]
OWN = re.compile(r"(^|\.)(google|googleapis|gstatic|gvt1|googleusercontent)\.com")  # what the browser asks for on its own

# Runs in the page: what its boxes say. Frames that it is in get the answer.
PROBE = r"""
(function () {
  'use strict';
  var OPTIONS = __OPTIONS__;
  function all(selector, inside) { return Array.prototype.slice.call((inside || document).querySelectorAll(selector)); }
  function shown(e) { var b = e.getBoundingClientRect(); return b.width > 0 && b.height > 0; }
  function channel(v) { v /= 255; return v <= 0.03928 ? v / 12.92 : Math.pow((v + 0.055) / 1.055, 2.4); }
  function luminance(colour) { var c = colour.match(/[\d.]+/g).map(Number); return 0.2126 * channel(c[0]) + 0.7152 * channel(c[1]) + 0.0722 * channel(c[2]); }
  function contrast(element, ground) {
    var style = getComputedStyle(element), ink = luminance(element.namespaceURI.indexOf('svg') > 0 ? style.fill : style.color);
    return (Math.max(ink, ground) + 0.05) / (Math.min(ink, ground) + 0.05);
  }
  function isDark() { return luminance(getComputedStyle(document.body).backgroundColor) < 0.2 ? 'dark' : 'light'; }
  function words(e) { return e.textContent.slice(0, 60); }
  function measure() {
    var out = {title: document.title, plots: 0, pictures: 0, outside: [], collisions: [], spilled: [], flat: []};
    var page = document.documentElement;
    out.sideways = page.scrollWidth - page.clientWidth;
    all('.plot').forEach(function (plot) {
      var box = plot.getBoundingClientRect(), texts = all('text', plot).map(function (t) { return [t, t.getBoundingClientRect()]; });
      if (!shown(plot)) { if (!plot.closest('details:not([open])')) out.flat.push(plot.id || 'plot'); return; }
      out.plots++;
      texts.forEach(function (t, i) {
        if (t[1].left < box.left - 1 || t[1].right > box.right + 1 || t[1].top < box.top - 1 || t[1].bottom > box.bottom + 1) out.outside.push(words(t[0]));
        for (var j = 0; j < i; j++) {
          var o = texts[j][1], w = Math.min(t[1].right, o.right) - Math.max(t[1].left, o.left), h = Math.min(t[1].bottom, o.bottom) - Math.max(t[1].top, o.top);
          if (w > 1 && h > 4) out.collisions.push(words(t[0]) + ' / ' + words(texts[j][0]));
        }
      });
    });
    all('.picture').forEach(function (p) {
      if (shown(p)) out.pictures++;
      else if (!p.closest('.two, .store, .over, details:not([open])') && !p.closest('.flip') && getComputedStyle(p.closest('figure') || p).display !== 'none') out.flat.push(p.getAttribute('aria-label'));
    });
    all('h1,h2,h3,h4,p,dd,dt,li,figcaption,code,button,th,td,summary,.value,.card').forEach(function (e) {
      if (!shown(e)) return;
      if (e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).display !== 'inline') out.spilled.push(e.tagName + ': ' + words(e));
      if (!e.closest('.scroll,.plotbox,nav') && e.getBoundingClientRect().right > page.clientWidth + 1) out.spilled.push(e.tagName + ' right: ' + words(e));
    });
    var ground = luminance(getComputedStyle(document.body).backgroundColor);
    out.contrast = Math.min.apply(null, all('h1,h2,p,dt,dd,figcaption,nav a,summary,.mark,.plot text,.hint,.range').filter(shown).map(function (e) { return contrast(e, ground); }).concat([21]));
    out.buttons = all('button').filter(shown).length;
    return out;
  }
  function act(out) {
    var button = document.getElementById('theme'), point = document.querySelector('.point[tabindex]'), flip = document.querySelector('.flip'), slider = document.querySelector('input[type=range]');
    if (button) { out.theme = []; for (var i = 0; i < 2; i++) { out.theme.push(isDark()); button.click(); } }
    if (point) { point.dispatchEvent(new FocusEvent('focus')); var tip = document.getElementById('tip'); out.tip = shown(tip) ? tip.textContent : ''; }
    if (flip) { var box = flip.querySelector('input'); box.click(); out.flipped = shown(flip.querySelector('.two .picture')) && !shown(flip.querySelector('.one .picture')); box.click(); }
    if (slider) { slider.value = 40; slider.dispatchEvent(new Event('input')); out.wiped = /40%/.test(document.querySelector('.over').style.clipPath); }
    return out;
  }
  addEventListener('load', function () {
    if (OPTIONS.theme) document.documentElement.setAttribute('data-theme', OPTIONS.theme);
    all('.openall').forEach(function (b) { b.click(); });
    all('details').forEach(function (d) { d.open = true; });
    setTimeout(function () {
      var out = measure();
      out.details = all('details').length;
      out.opened = all('details[open]').length;
      if (!OPTIONS.scriptless) act(out);
      parent.postMessage({name: OPTIONS.name, result: out}, '*');
    }, 50);
  });
})();
"""


class Seen:
    def __init__(self, results, console, requests):
        self.results, self.console, self.requests = results, console, requests


class _Proxy(http.server.BaseHTTPRequestHandler):
    def answer(self):
        if not OWN.search(self.path.split("//")[-1].split("/")[0].split(":")[0]):
            self.server.requests.append(f"{self.command} {self.path}")
        self.send_error(502)

    do_GET = do_POST = do_CONNECT = do_HEAD = do_OPTIONS = answer

    def log_message(self, *_):
        pass


def _chromium(arguments, folder):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), _Proxy)
    server.requests = []
    threading.Thread(target=server.serve_forever, daemon=True).start()
    # A home of its own, so that nothing of the user's is read or written.
    environment = dict(os.environ, HOME=folder, XDG_CONFIG_HOME=folder, XDG_CACHE_HOME=folder)
    command = ["chromium", *QUIET, f"--user-data-dir={folder}/profile", f"--proxy-server=127.0.0.1:{server.server_address[1]}", *arguments]
    try:
        done = subprocess.run(command, capture_output=True, timeout=SECONDS, check=False, env=environment, stdin=subprocess.DEVNULL)
    finally:
        server.shutdown()
        server.server_close()
    errors = done.stderr.decode("utf-8", "replace")
    if done.returncode != 0:
        raise RuntimeError(f"chromium ended with {done.returncode}: {errors[-2000:]}")
    return done.stdout.decode("utf-8", "replace"), [line for line in errors.splitlines() if "CONSOLE" in line], server.requests


def look(frames):
    """frames: (name, page, width, options). Opens all of them in one run, each in a frame of its width, and measures it. options: theme; scriptless: the page's own script does not run."""
    with tempfile.TemporaryDirectory(prefix="burnish-browser-") as folder:
        inside = []
        for index, (name, page, width, options) in enumerate(frames):
            text = pathlib.Path(page).read_text("utf-8")
            if options.get("scriptless"):
                text = re.sub(r"<script>.*?</script>", "", text, flags=re.S)
            copy = pathlib.Path(folder) / f"frame{index}.html"
            copy.write_text(text + "<script>" + PROBE.replace("__OPTIONS__", json.dumps({"name": name, **options})) + "</script>", "utf-8")
            inside.append(f'<iframe src="{copy.name}" style="width:{width}px;height:900px;border:0"></iframe>')
        judge = pathlib.Path(folder) / "judge.html"
        judge.write_text('<!DOCTYPE html><meta charset=utf-8><script>var got={};addEventListener("message",function(e){got[e.data.name]=e.data.result;'
                         'document.getElementById("got").textContent=JSON.stringify(got)})</script><pre id=got>{}</pre>' + "".join(inside), "utf-8")
        dom, console, requests = _chromium(["--virtual-time-budget=8000", "--window-size=1400,1000", "--dump-dom", judge.as_uri()], folder)
        found = re.search(r'<pre id="got">(.*?)</pre>', dom, re.S)
        return Seen(json.loads(html.unescape(found.group(1))) if found else {}, console, requests)


def screenshot(page, width, height, dark):
    with tempfile.TemporaryDirectory(prefix="burnish-browser-") as folder:
        file = pathlib.Path(folder) / "shot.png"
        _chromium(["--virtual-time-budget=3000", f"--blink-settings=preferredColorScheme={0 if dark else 1}", f"--window-size={width},{height}", f"--screenshot={file}", pathlib.Path(page).as_uri()], folder)
        return file.read_bytes()


def png_rows(data, most):
    """The first rows of an 8-bit RGB or RGBA PNG, as RGB bytes."""
    at, width, height, kind, packed = 8, 0, 0, 0, b""
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if name == b"IHDR":
            width, height, depth, kind = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and kind in (2, 6)
        elif name == b"IDAT":
            packed += body
        at += size + 12
    channels = 3 if kind == 2 else 4
    raw, stride, rows, above = zlib.decompress(packed), width * channels, [], bytes(width * channels)
    for y in range(min(height, most)):
        method, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        if method:
            for i in range(stride):
                left, up = (line[i - channels] if i >= channels else 0), above[i]
                if method == 1:
                    line[i] = (line[i] + left) & 255
                elif method == 2:
                    line[i] = (line[i] + up) & 255
                elif method == 3:
                    line[i] = (line[i] + (left + up) // 2) & 255
                else:
                    corner = above[i - channels] if i >= channels else 0
                    guess = left + up - corner
                    a, b, c = abs(guess - left), abs(guess - up), abs(guess - corner)
                    line[i] = (line[i] + (left if a <= b and a <= c else up if b <= c else corner)) & 255
        above = bytes(line)
        rows.append(above if channels == 3 else bytes(v for i, v in enumerate(above) if i % 4 != 3))
    return rows
