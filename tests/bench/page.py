"""Results as one self-contained HTML page: log-log plots of error against CPU seconds, inline SVG, and tables."""
import math
from html import escape

import results

# Colours that colour-blind readers tell apart (Okabe & Ito 2008), given to the methods in their order.
COLOURS = ('#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#000000')
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 520, 360, 62, 12, 10, 40  # of a plot and its margins, in pixels
DASHES = {'error': '', 'variance': '6 4', 'bias2': '2 3'}
# What is drawn of the guide line, which knows no bounds.
CLIP = (f'<clipPath id="inside"><rect x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" '
        f'height="{HEIGHT - TOP - BOTTOM}"/></clipPath>')

STYLE = '''body { font: 15px/1.45 system-ui, sans-serif; max-width: 76rem; margin: 1.5rem auto; padding: 0 1rem; }
.charts { display: flex; flex-wrap: wrap; gap: 1rem 2rem; } figure { margin: 0; } figcaption { font-weight: 600; }
svg { background: #fff; } svg text { font: 11px system-ui, sans-serif; fill: #333; }
table { border-collapse: collapse; font-size: 12px; margin: .4rem 0; } summary { cursor: pointer; font-size: 13px; }
td, th { padding: .1rem .5rem; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }
td:first-child, th:first-child { text-align: left; } .key span { margin-right: 1.2rem; font-weight: 600; }
.wide { overflow-x: auto; }'''

LEGEND = '''Error is <code>relMSE</code>, the mean of (I-A)(I-B)/(R<sup>2</sup>+.01), or for single path classes
<code>norm</code>, the sum of (I-A)(I-B) over that of R<sup>2</sup>. R is the truth, A and B are independent halves of
it, so that its own noise drops out. Full line: error, with one standard error. Dashed: variance. Dotted with squares:
bias<sup>2</sup>; a triangle is an upper limit (two standard errors above what was found, for what cannot be told from
0). Grey: half the error for twice the time. CPU seconds are those of the whole run.'''


def at_most(value, sem):
    """What a logarithmic axis shows of a figure that may lie below its own noise: (value, whether it is a limit)."""
    if value > 2 * sem:
        return value, False
    return max(value, 0) + 2 * sem, True


def series(rows, part):
    """Points (CPU seconds, value, standard error, is a limit) of one curve; without those that no logarithm shows."""
    points = []
    for row in rows:
        figure = row[row['figure']]
        value, sem = figure[part], figure.get(f'{part}_sem', 0)
        if value is None:
            continue
        limit = False
        if part == 'bias2' or value <= 0:
            value, limit = at_most(value, sem)
        if value > 0 and results.cpu(row) > 0:
            points.append((results.cpu(row), value, sem, limit))
    return points


class Axis:
    """Maps a range of values, widened a little, to pixels by their logarithm."""

    def __init__(self, values, begin, end):
        margin = 1.25
        self.low, self.high = math.log10(min(values) / margin), math.log10(max(values) * margin)
        self.begin, self.end = begin, end

    def __call__(self, value):
        return self.begin + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.begin)

    def ticks(self):
        decades = range(math.floor(self.low), math.ceil(self.high) + 1)
        steps = (1, 3) if self.high - self.low < 4 else (1,)
        return [m * 10.0 ** d for d in decades for m in steps if self.low <= math.log10(m * 10.0 ** d) <= self.high]


def grid(x, y):
    parts = []
    for t in x.ticks():
        parts.append(f'<line x1="{x(t):.1f}" x2="{x(t):.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}" stroke="#e4e4e4"/>'
                     f'<text x="{x(t):.1f}" y="{HEIGHT - BOTTOM + 15}" text-anchor="middle">{t:g}</text>')
    for t in y.ticks():
        parts.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y(t):.1f}" y2="{y(t):.1f}" stroke="#e4e4e4"/>'
                     f'<text x="{LEFT - 6}" y="{y(t) + 4:.1f}" text-anchor="end">{t:.0e}</text>')
    parts.append(f'<text x="{(LEFT + WIDTH) / 2:.0f}" y="{HEIGHT - 6}" text-anchor="middle">CPU seconds</text>')
    return parts


def curve(points, x, y, colour, dash, name):
    """A line through the points, marked by discs, squares (bias) or, for limits, triangles."""
    path = ' '.join(f'{x(t):.1f},{y(v):.1f}' for t, v, _, _ in points)
    parts = [f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.6" stroke-dasharray="{dash}"/>']
    for t, value, sem, limit in points:
        px, py = x(t), y(value)
        title = f'<title>{escape(name)}: {t:.2f} s, {"at most " if limit else ""}{value:.2e} ± {sem:.1e}</title>'
        if limit:
            parts.append(f'<path d="M{px - 4:.1f} {py - 3:.1f}h8l-4 7z" fill="#fff" stroke="{colour}">{title}</path>')
        elif 'bias' in name:
            parts.append(f'<rect x="{px - 3:.1f}" y="{py - 3:.1f}" width="6" height="6" fill="#fff" stroke="{colour}">'
                         f'{title}</rect>')
        else:
            parts.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3" fill="{colour}">{title}</circle>')
            if 0 < sem < value:
                parts.append(f'<line x1="{px:.1f}" x2="{px:.1f}" y1="{y(value - sem):.1f}" y2="{y(value + sem):.1f}" '
                             f'stroke="{colour}"/>')
    return parts


def chart(methods, colours, parts=('error', 'variance', 'bias2')):
    """One plot as SVG; a sentence where there is nothing that a logarithm shows."""
    curves = [(method, part, DASHES[part], points) for method, rows in methods.items() for part in parts
              if (points := series(rows, part))]
    if not curves:
        return '<p>Nothing above zero.</p>'
    times = [p[0] for *_, points in curves for p in points]
    values = [p[1] for *_, points in curves for p in points]
    x, y = Axis(times, LEFT, WIDTH - RIGHT), Axis(values, HEIGHT - BOTTOM, TOP)
    shapes = grid(x, y)
    guide = max(p[0] * p[1] for p in curves[0][3])  # error times CPU seconds stays the same
    begin, end = min(times), max(times)
    shapes.append(f'<line x1="{x(begin):.1f}" y1="{y(guide / begin):.1f}" x2="{x(end):.1f}" y2="{y(guide / end):.1f}" '
                  'stroke="#bbb" clip-path="url(#inside)"/>')
    for method, part, dash, points in curves:
        shapes += curve(points, x, y, colours[method], dash, f'{method}, {part}')
    return (f'<svg width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" role="img">'
            + ''.join(shapes) + '</svg>')


def colours_of(result):
    names = list(dict.fromkeys(row['method'] for row in result['rows']))
    return {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(names)}


def picture(result, scene, path_class, title):
    """One plot as an SVG file of its own, its error curves alone, with a title and the methods' names. Raises KeyError
    if there is no such scene or class."""
    charts = results.charts(result['rows'])
    if (scene, path_class) not in charts:
        there = ', '.join(f'"{name}" "{c}"' for name, c in charts)
        raise KeyError(f'"{scene}" "{path_class}": not in the result, expected one of {there}')
    methods = charts[scene, path_class]
    colours = colours_of(result)
    top = 42
    names = ''.join(f'<tspan fill="{colours[name]}" dx="{12 if i else 0}" font-weight="600">{escape(name)}</tspan>'
                    for i, name in enumerate(methods))
    inner = chart(methods, colours, parts=('error',))
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT + top}" '
            f'viewBox="0 0 {WIDTH} {HEIGHT + top}"><style>text {{ font: 11px system-ui, sans-serif; fill: #333; }} '
            f'.title {{ font-size: 13px; }}</style><rect width="100%" height="100%" fill="#fff"/>{CLIP}'
            f'<text class="title" x="{LEFT}" y="17">{escape(title)}</text><text x="{LEFT}" y="34">{names}</text>'
            f'<g transform="translate(0 {top})">{inner}</g></svg>\n')


def html_table(header, lines):
    def row(cells, tag):
        return '<tr>' + ''.join(f'<{tag}>{escape(c)}</{tag}>' for c in cells) + '</tr>'
    return f'<div class="wide"><table>{row(header, "th")}{"".join(row(line, "td") for line in lines)}</table></div>'


def page(result):
    """The whole page as text."""
    charts = results.charts(result['rows'])
    colours = colours_of(result)
    key = ''.join(f'<span style="color: {colours[name]}">{escape(name)}</span>' for name in colours)
    parts = ['<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>lsde: convergence</title>'
             f'<style>{STYLE}</style><h1>Convergence</h1><p>{LEGEND}</p>'
             f'<p>Seeds: {result["seeds"]}. Program: {result["program"][:16]}.</p>'
             f'<p class="key">{key}</p><svg width="0" height="0">{CLIP}</svg>']
    for scene in dict.fromkeys(scene for scene, _ in charts):
        parts.append(f'<h2>{escape(scene)}</h2><div class="charts">')
        for (name, path_class), methods in charts.items():
            if name == scene:
                figure = next(iter(methods.values()))[0]['figure']
                table = html_table(*results.error_table(methods))
                parts.append(f'<figure><figcaption>{escape(path_class)} ({figure})</figcaption>'
                             f'{chart(methods, colours)}<details><summary>Figures</summary>{table}</details></figure>')
        parts.append('</div>')
    header, lines = results.yardstick(result['rows'])
    if lines:
        parts.append('<h2>The yardstick: each rendered alone (norm)</h2>' + html_table(header, lines))
    if result['left_out']:
        parts.append('<h2>Left out</h2>' + html_table(['scene', 'method', 'reason'], result['left_out']))
    return '\n'.join(parts) + '\n'
