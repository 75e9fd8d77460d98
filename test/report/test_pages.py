# Copyright 2026 rrr_traj_planner developers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Pages in a real browser: no error, no request, every figure there and legible, at every size."""

from __future__ import annotations

import re

import pytest
from rrr_traj_planner.planners.registry import planner_ids

PHONE, DESKTOP = (375, 812), (1280, 900)
LEAST_TEXT = 7.0      # CSS pixels: what is smaller is not legible
LEAST_CONTRAST = 4.5  # of text on its ground (WCAG 2.1, AA)
FIGURES = [*(f'figure_3_{i}' for i in (1, 2, 3)), *(f'figure_4_{i}' for i in (1, 3, 4, 5)),
           *(f'figure_6_{i}' for i in (*range(2, 10), 12, 13)), 'torque_line_arc',
           'torque_line_polynomial', 'times_table_6_1', 'times_table_6_3', 'claim_spectra',
           'claim_vibrations']
PLAN_FIGURES = ['vibration', 'paths', *(f'compared_{i}' for i in (1, 2, 3)), *(
    f'{kind}_{planner}' for kind in ('profiles', 'torque', 'path')
    for planner in ('cycloid', 'line_arc', 'time_optimal'))]

SIZES = """[...document.querySelectorAll('figure.picture')].map((f) => {
  const r = f.querySelector('svg').getBoundingClientRect();
  return [f.id, r.width, r.height, r.right]; })"""

# Text of every picture: its height, and whether it is inside its picture.
TEXTS = """[...document.querySelectorAll('figure.picture svg text')].map((t) => {
  const r = t.getBoundingClientRect(), s = t.closest('svg').getBoundingClientRect();
  const m = t.getScreenCTM(), scale = Math.hypot(m.a, m.b);
  return [t.closest('figure').id + ': ' + t.textContent,
    scale * parseFloat(getComputedStyle(t).fontSize),
    Math.max(s.left - r.left, r.right - s.right, s.top - r.top, r.bottom - s.bottom)]; })"""

# Pairs of texts of one picture that lie on each other.
OVERLAPS = """[...document.querySelectorAll('figure.picture svg')].flatMap((s) => {
  const texts = [...s.querySelectorAll('text')].map((t) => [t.textContent,
    t.getBoundingClientRect()]);
  return texts.flatMap(([a, p], i) => texts.slice(i + 1).filter(([b, q]) =>
    Math.min(p.right, q.right) - Math.max(p.left, q.left) > 2
    && Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top) > 0.35 * Math.min(p.height, q.height)
  ).map(([b]) => s.closest('figure').id + ': ' + a + ' | ' + b)); })"""

COLOURS = """[getComputedStyle(document.body).backgroundColor,
  getComputedStyle(document.body).color,
  ...['figcaption', 'figure.picture svg text', 'td', 'thead th'].map((s) => {
    const c = getComputedStyle(document.querySelector(s));
    return s.includes('svg') ? c.fill : c.color; })]"""


@pytest.fixture(scope='module', params=['thesis_page', 'plan_page'])
def page(request):
    """Return each page."""
    return request.getfixturevalue(request.param)


@pytest.fixture(
    scope='module', params=[(*PHONE, False), (*PHONE, True), (*DESKTOP, False), (*DESKTOP, True)],
    ids=['phone light', 'phone dark', 'desktop light', 'desktop dark'])
def view(request, window, page):
    """Show each page in each size and theme; return width, height and whether dark is liked."""
    window.show(page, *request.param)
    return request.param


def luminance(colour):
    """Return a colour's luminance as WCAG defines it."""
    parts = [int(x) / 255.0 for x in re.findall(r'\d+', colour)[:3]]
    linear = [x / 12.92 if x <= 0.03928 else ((x + 0.055) / 1.055) ** 2.4 for x in parts]
    return sum(w * x for w, x in zip((0.2126, 0.7152, 0.0722), linear))


def contrast(one, other):
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def test_page_is_shown_without_error_request_or_scrolling_sideways(window, page, view):
    assert window.complaints() == []
    assert [u for u in window.requests() if not u.startswith('data:')] == [page.as_uri()]
    assert window.value('document.documentElement.scrollWidth') <= view[0]


def test_every_figure_has_a_size_and_fits(window, page, view):
    sizes = window.value(SIZES)
    assert {name for name, *_ in sizes} >= set(
        FIGURES if page.parent.name.startswith('thesis') else PLAN_FIGURES)
    for name, width, height, right in sizes:
        assert (width >= 290 and height >= 150 and right <= view[0]), name


@pytest.mark.usefixtures('view')
def test_text_of_figures_is_legible_and_not_cut(window):
    texts = window.value(TEXTS)
    assert len(texts) > 300
    assert [t for t in texts if t[1] < LEAST_TEXT] == []
    assert [t for t in texts if t[2] > 0.5] == []


@pytest.mark.usefixtures('view')
def test_no_texts_of_a_figure_overlap(window):
    assert window.value(OVERLAPS) == []


def test_text_has_contrast_in_both_themes(window, view):
    ground, *texts = window.value(COLOURS)
    assert (luminance(ground) < 0.1) == view[2]
    assert min(contrast(ground, text) for text in texts) >= LEAST_CONTRAST


def test_colours_of_figures_follow_the_reader(window, thesis_page):
    stroke = ("getComputedStyle(document.querySelector('#figure_6_3 svg path[style*=joint-1]'))"
              '.stroke')
    seen = []
    for dark in (False, True):
        window.show(thesis_page, *DESKTOP, dark)
        seen.append(window.value(stroke))
    assert seen == ['rgb(0, 114, 178)', 'rgb(86, 180, 233)']


def test_ids_of_the_page_are_unique(window, page):
    window.show(page, *DESKTOP, False)
    assert window.value("""(() => { const ids = [...document.querySelectorAll('[id]')]
        .map((e) => e.id); return ids.filter((x, i) => ids.indexOf(x) !== i); })()""") == []


def test_wide_tables_scroll_in_their_own_box(window, thesis_page):
    window.show(thesis_page, *PHONE, False)
    box = "document.querySelector('#methods_table_6_1 .scroll')"
    assert window.value(f'{box}.scrollWidth > {box}.clientWidth')
    assert window.value(f'{box}.getBoundingClientRect().right') <= PHONE[0]


def test_every_planner_has_its_row(window, thesis_page):
    window.show(thesis_page, *DESKTOP, False)
    for table in ('methods_table_6_1', 'methods_table_6_3'):
        rows = window.value(f"[...document.querySelectorAll('#{table} tbody th')]"
                            '.map((e) => e.textContent)')
        assert rows == planner_ids()


@pytest.mark.parametrize(('width', 'height'), [(400, 812), (1400, 900)])
def test_page_of_many_points_and_a_refusal_is_legible(window, many_points_page, width, height):
    window.show(many_points_page, width, height, False)
    assert window.complaints() == []
    assert window.value('document.documentElement.scrollWidth') <= width
    assert window.value("document.querySelector('header p').textContent") == (
        '60 via points [m]: from (0.809104, 0.8, 1) to (0.809104, 0.8, 1).')
    assert window.value("document.querySelector('#refusals td').textContent").startswith(
        "refused: via point 2: (2, 0, 0.5) m is out of the arm's reach: it misses by 0.4 m")
    cut = window.value("""[...document.querySelectorAll('#refusals td, #refusals th')].filter(
      (c) => { const r = document.createRange(); r.selectNodeContents(c);
        const box = c.closest('.scroll').getBoundingClientRect();
        return r.getBoundingClientRect().right > box.right + 0.5; }).length""")
    assert cut == 0
    assert window.value(OVERLAPS) == []
    assert window.value("document.querySelectorAll('#via_points tbody tr').length") == 60
    assert window.value("document.querySelector('#via_points .scroll').clientHeight") < height


@pytest.mark.parametrize(('width', 'height'), [(400, 812), (1400, 900), (812, 375)])
def test_animation_fits_the_window_with_its_controls(window, many_points_page, width, height):
    window.show(many_points_page, width, height, True)
    top, bottom = window.value("""(() => { const f = document.querySelector('figure.animation');
      return [f.querySelector('.controls').getBoundingClientRect().top,
        f.querySelector('canvas').getBoundingClientRect().bottom]; })()""")
    assert 0.0 < bottom - top <= height
    text = window.value("document.querySelector('.arms p').textContent")
    assert re.fullmatch(
        r"now joint_\d's (velocity|acceleration|jerk|torque) at \d+ % of its limit", text)


def picture_of(window, index=0):
    """Return a canvas's picture as a text."""
    return window.value(f"document.querySelectorAll('canvas')[{index}].toDataURL()")


def scrub(window, place):
    window.value(f"(() => {{ const s = document.querySelector('.time'); s.value = {place}; "
                 "s.dispatchEvent(new Event('input')); })()")


def test_animation_is_scrubbed(window, plan_page):
    window.show(plan_page, *DESKTOP, False)
    assert window.value("document.querySelectorAll('canvas').length") == 3
    begin = picture_of(window)
    scrub(window, 500)
    middle = picture_of(window)
    scrub(window, 1000)
    assert len({begin, middle, picture_of(window)}) == 3
    assert window.value("document.querySelector('output').textContent") == '2.85 of 2.85 s'
    scrub(window, 0)
    assert picture_of(window) == begin


def test_animation_runs_and_is_paused(window, plan_page):
    window.show(plan_page, *DESKTOP, True)
    press = "document.querySelector('.play').click()"
    wait = 'new Promise((done) => setTimeout(() => done(true), 300))'
    state = "document.querySelector('.play').textContent"
    begin = picture_of(window)
    window.value(press)
    assert window.value(state) == 'Pause'
    window.until("parseFloat(document.querySelector('output').textContent) > 0.4")
    window.value(press)
    paused = picture_of(window)
    assert paused != begin
    assert window.value(state) == 'Play'
    window.value(wait)
    assert picture_of(window) == paused
    assert window.complaints() == []


def test_animation_ends_at_rest_and_starts_again(window, plan_page):
    window.show(plan_page, *PHONE, False)
    scrub(window, 990)
    window.value("document.querySelector('.play').click()")
    window.until("document.querySelector('.play').textContent === 'Play'")
    assert 'at rest' in window.value("document.querySelector('.arms p').textContent")


def test_dragging_turns_the_view(window, plan_page):
    window.show(plan_page, *DESKTOP, False)
    before = picture_of(window, 1)
    box = window.value("(() => { document.querySelector('canvas').scrollIntoView(); const r = "
                       "document.querySelector('canvas').getBoundingClientRect(); "
                       'return [r.x + r.width / 2, r.y + r.height / 2]; })()')
    for kind, shift in (('mousePressed', 0), ('mouseMoved', 60), ('mouseReleased', 60)):
        window.ask('Input.dispatchMouseEvent', type=kind, x=box[0] + shift, y=box[1],
                   button='left', buttons=1, clickCount=1)
    assert picture_of(window, 1) != before


def test_contrast_is_that_of_wcag():
    assert contrast('rgb(0, 0, 0)', 'rgb(255, 255, 255)') == pytest.approx(21.0)
    assert luminance('rgb(128, 128, 128)') == pytest.approx(0.2159, abs=1e-3)
