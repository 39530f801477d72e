"""Line plots as SVG, written directly: axes with units, error bars, a legend. Readable on light and
on dark ground."""
import math

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7"
          )  # Okabe and Ito: distinguishable for colour-blind readers
STYLE = """<style>
text { font: 13px sans-serif; fill: #333 } .axis { stroke: #333; fill: none } .grid { stroke: #8886 }
.title { font-weight: bold } svg { background: #fff }
@media (prefers-color-scheme: dark) { text { fill: #ddd } .axis { stroke: #ddd } svg { background: #16181d } }
</style>"""
PANEL_WIDTH, PANEL_HEIGHT, LEFT, TOP, BOTTOM, GAP = 330, 300, 75, 45, 60, 90


class Panel:
    """A plot: series of (x, y, half width of the error bar) with linear x and linear or logarithmic
    y."""

    def __init__(self, title, x_label, y_label, x_ticks, y_ticks, logarithmic=False):
        self.title, self.x_label, self.y_label = title, x_label, y_label
        self.x_ticks, self.y_ticks, self.logarithmic = x_ticks, y_ticks, logarithmic
        self.series = []

    def add(self, name, points, colour, dashed=False, joined=True):
        self.series.append((name, points, COLOURS[colour], dashed, joined))

    def draw(self, left):
        scale = math.log10 if self.logarithmic else float
        low, high = scale(self.y_ticks[0]), scale(self.y_ticks[-1])
        x0, x1 = self.x_ticks[0], self.x_ticks[-1]

        def across(x):
            return left + PANEL_WIDTH * (x - x0) / (x1 - x0)

        def down(y):
            return TOP + PANEL_HEIGHT * (high - scale(y)) / (high - low)

        middle = left + PANEL_WIDTH / 2
        out = [text(middle, TOP - 18, self.title, "middle", "title")]
        for x in self.x_ticks:
            out += [line(across(x), TOP + PANEL_HEIGHT, across(x), TOP + PANEL_HEIGHT + 5, "axis"),
                    text(across(x), TOP + PANEL_HEIGHT + 20, f"{x:g}", "middle")]
        for y in self.y_ticks:
            out += [
                line(left, down(y), left + PANEL_WIDTH, down(y), "grid"),
                text(left - 8,
                     down(y) + 4, f"{y:g}", "end")
            ]
        out += [
            f'<rect x="{left}" y="{TOP}" width="{PANEL_WIDTH}" height="{PANEL_HEIGHT}" class="axis"/>',
            text(middle, TOP + PANEL_HEIGHT + 45, self.x_label, "middle"),
            f'<text transform="translate({left - 55} {TOP + PANEL_HEIGHT / 2}) rotate(-90)" text-anchor="middle">'
            f"{self.y_label}</text>"
        ]
        for _, points, *look in self.series:
            out += draw_series([(across(x), y, half) for x, y, half in points], down, *look)
        return out


def line(xa, ya, xb, yb, kind=None, style=""):
    return (f'<line x1="{xa:.1f}" y1="{ya:.1f}" x2="{xb:.1f}" y2="{yb:.1f}"' +
            (f' class="{kind}"' if kind else "") + style + "/>")


def text(x, y, words, anchor="start", kind=None):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"' + (f' class="{kind}"' if kind
                                                                      else "") + f">{words}</text>"


def draw_series(points, down, colour, dashed, joined):
    style = f' stroke="{colour}"' + (' stroke-dasharray="5 4"' if dashed else "")
    path = " ".join(f"{x:.1f},{down(y):.1f}" for x, y, _ in points)
    out = [f'<polyline points="{path}" fill="none" stroke-width="1.5"{style}/>'] if joined else []
    for x, y, half in points:
        if half:
            a, b = down(y - half), down(y + half)
            out += [
                line(xa, ya, xb, yb, style=f' stroke="{colour}"')
                for xa, ya, xb, yb in ((x, a, x, b), (x - 4, a, x + 4, a), (x - 4, b, x + 4, b))
            ]
        # Open marks for dashed series.
        out.append(
            f'<circle cx="{x:.1f}" cy="{down(y):.1f}" r="3.5" stroke="{colour}" fill="{"none" if dashed else colour}"/>'
        )
    return out


def figure(panels, legend_columns=3):
    """@return the SVG of panels side by side, with the first one's legend under them"""
    width = LEFT + len(panels) * PANEL_WIDTH + (len(panels) - 1) * GAP + 20
    top_of_legend = TOP + PANEL_HEIGHT + BOTTOM + 10
    rows = -(-len(panels[0].series) // legend_columns)
    height = top_of_legend + 22 * rows + 5
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">',
        STYLE
    ]
    for k, panel in enumerate(panels):
        out += panel.draw(LEFT + k * (PANEL_WIDTH + GAP))
    for k, (name, _, *look) in enumerate(panels[0].series):
        x, y = LEFT + (k % legend_columns) * (width - LEFT) / legend_columns, top_of_legend + 22 * (
            k // legend_columns)
        out += draw_series([(x, y, 0), (x + 30, y, 0)][:2 if look[-1] else 1], float, *look)
        out.append(text(x + 42, y + 4, name))
    return "\n".join(out + ["</svg>", ""])
