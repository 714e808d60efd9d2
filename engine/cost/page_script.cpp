#include "cost/page.h"

namespace burnish::cost {
namespace {

// The page is whole without it. Texts are only ever set as text.
constexpr std::string_view kScript = R"((function () {
  'use strict';
  var root = document.documentElement;
  function each(selector, action) { Array.prototype.forEach.call(document.querySelectorAll(selector), action); }
  function remembered(value) {  // storage may be closed to files
    try {
      if (value) localStorage.setItem('burnish-theme', value);
      return localStorage.getItem('burnish-theme');
    } catch (error) { return null; }
  }
  function isDark() {
    var set = root.getAttribute('data-theme');
    return set ? set === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
  }
  var theme = document.getElementById('theme');
  function name() { theme.textContent = isDark() ? 'Light' : 'Dark'; theme.setAttribute('aria-label', 'Switch to the ' + (isDark() ? 'light' : 'dark') + ' theme'); }
  var kept = remembered();
  if (kept === 'dark' || kept === 'light') root.setAttribute('data-theme', kept);
  theme.hidden = false;
  theme.addEventListener('click', function () {
    var next = isDark() ? 'light' : 'dark';
    root.setAttribute('data-theme', next);
    remembered(next);
    name();
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', name);
  name();

  var copy = document.getElementById('copy'), command = document.getElementById('command');
  if (copy && command) {
    copy.hidden = false;
    copy.addEventListener('click', function () {
      var range = document.createRange();
      range.selectNodeContents(command);
      getSelection().removeAllRanges();
      getSelection().addRange(range);
      if (navigator.clipboard) navigator.clipboard.writeText(command.textContent).then(function () { copy.textContent = 'Copied'; }, function () {});
    });
  }

  // What a plot's mark says, beside the pointer or the mark that has the focus.
  var tip = document.createElement('div');
  tip.id = 'tip';
  tip.setAttribute('role', 'status');
  tip.hidden = true;
  document.body.appendChild(tip);
  function show(mark, x, y) {
    tip.textContent = mark.getAttribute('aria-label');
    tip.hidden = false;
    var left = Math.min(x + 14, innerWidth - tip.offsetWidth - 8), top = y + 16;
    if (top + tip.offsetHeight > innerHeight - 8) top = y - tip.offsetHeight - 12;
    tip.style.transform = 'translate(' + Math.max(left, 8) + 'px,' + Math.max(top, 8) + 'px)';
  }
  function hide() { tip.hidden = true; }
  each('.plot .point, .plot .row', function (mark) {
    var title = mark.querySelector('title');
    if (title) mark.removeChild(title);
    mark.addEventListener('pointermove', function (event) { show(mark, event.clientX, event.clientY); });
    mark.addEventListener('pointerleave', hide);
    mark.addEventListener('focus', function () {
      var box = mark.getBoundingClientRect();
      show(mark, box.right, (box.top + box.bottom) / 2);
    });
    mark.addEventListener('blur', hide);
  });
  document.addEventListener('keydown', function (event) { if (event.key === 'Escape') hide(); });
  addEventListener('scroll', hide, {passive: true});

  each('.openall', function (button) {
    var all = button.closest('section').querySelectorAll('details'), open = false;
    button.hidden = false;
    button.addEventListener('click', function () {
      open = !open;
      Array.prototype.forEach.call(all, function (d) { d.open = open; });
      button.textContent = (open ? 'Close' : 'Open') + ' all pictures and tables';
      button.setAttribute('aria-expanded', open);
    });
  });
  addEventListener('beforeprint', function () { each('details', function (d) { d.open = true; }); });

  // A slider under each large picture: to its left the first one, to its right what it is held against.
  each('.triptych.large .flip', function (flip) {
    var first = flip.querySelector('.one .picture'), second = flip.querySelector('.two .picture');
    if (!first || !second) return;
    var slider = document.createElement('input'), box = document.createElement('span');
    slider.type = 'range';
    slider.min = 0;
    slider.max = 100;
    slider.value = 100;
    slider.setAttribute('aria-label', first.getAttribute('aria-label') + ' to the left, ' + second.getAttribute('aria-label') + ' to the right');
    slider.style.width = '100%';
    box.className = 'wipe';
    flip.parentNode.insertBefore(box, flip);
    box.appendChild(flip);
    var over = second.cloneNode(true);
    over.setAttribute('class', 'picture over');
    over.setAttribute('aria-hidden', 'true');
    over.style.clipPath = 'inset(0 0 0 100%)';
    flip.insertBefore(over, flip.querySelector('.tag'));
    flip.closest('figure').appendChild(slider);
    slider.addEventListener('input', function () { over.style.clipPath = 'inset(0 0 0 ' + slider.value + '%)'; });
  });
})();
)";

}  // namespace

std::string_view pageScript() { return kScript; }

}  // namespace burnish::cost
