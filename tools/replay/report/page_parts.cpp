// SPDX-License-Identifier: MIT
// Style and script of the page of results.
#include "tools/replay/report/page_parts.hpp"

namespace unisim::report {

const char* const kStyle = R"css(
:root { color-scheme: light dark; --page: #f6f7f9; --card: #ffffff; --ink: #16202c; --soft: #5b6775;
  --edge: #dfe3e8; --grid: #e9ecf0; --estimate: #1f6feb; --live: #d9730d; --truth: #7c8794;
  --segment1: #0f8a6c; --segment2: #8250df; --segment3: #bf3989; --warn: #fff4d6; --warn-edge: #e0b341; }
@media (prefers-color-scheme: dark) {
  :root { --page: #0f141a; --card: #171d25; --ink: #e6ebf1; --soft: #97a3b1; --edge: #2a333f;
    --grid: #232b36; --estimate: #6cb0ff; --live: #f0a04b; --truth: #8d99a8; --segment1: #4cc9a4;
    --segment2: #b794f6; --segment3: #f082bd; --warn: #3a3015; --warn-edge: #8a6d1f; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 28px 18px 40px; }
header h1 { margin: 0; font-size: 27px; line-height: 1.25; letter-spacing: -0.01em; overflow-wrap: anywhere; }
header p { margin: 4px 0 0; color: var(--soft); overflow-wrap: anywhere; }
h2 { margin: 0 0 10px; font-size: 16px; font-weight: 650; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 164px), 1fr)); gap: 12px; margin: 22px 0 16px; }
.figure, section { background: var(--card); border: 1px solid var(--edge); border-radius: 10px; }
.figure { padding: 12px 14px; }
.figure .label { color: var(--soft); font-size: 13px; }
.figure .value { font-size: 21px; font-weight: 650; line-height: 1.3; font-variant-numeric: tabular-nums; }
.figure .note { color: var(--soft); font-size: 12.5px; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 400px), 1fr)); gap: 16px; margin-bottom: 16px; }
section { padding: 16px 16px 14px; min-width: 0; }
.stack { display: grid; gap: 16px; align-content: start; min-width: 0; }
section > p { margin: 8px 0 0; color: var(--soft); font-size: 13px; }
.warnings { background: var(--warn); border-color: var(--warn-edge); margin-bottom: 16px; }
.warnings ul { margin: 0; padding-left: 20px; overflow-wrap: anywhere; }
.legend { display: flex; flex-wrap: wrap; gap: 4px 16px; margin: -4px 0 6px; color: var(--soft); font-size: 13px; }
.legend i { display: inline-block; width: 20px; height: 0; border-top: 3px solid; vertical-align: middle; margin-right: 6px; }
.legend i.estimate { border-color: var(--estimate); } .legend i.live { border-color: var(--live); }
.legend i.truth { border-color: var(--truth); border-top-width: 6px; opacity: 0.5; }
.legend i.segment1 { border-color: var(--segment1); } .legend i.segment2 { border-color: var(--segment2); }
.legend i.segment3 { border-color: var(--segment3); }
svg { display: block; width: 100%; height: auto; overflow: visible; }
svg.chart { touch-action: pan-y; }
svg text { font-size: 12px; fill: var(--soft); font-variant-numeric: tabular-nums; }
svg .name { font-size: 12px; }
svg .end-label { font-size: 12px; fill: var(--ink); paint-order: stroke; stroke: var(--card); stroke-width: 3px; }
svg .grid { stroke: var(--grid); stroke-width: 1; }
svg .frame { stroke: var(--edge); stroke-width: 1; fill: none; }
svg .line { fill: none; stroke-width: 1.8; stroke-linejoin: round; stroke-linecap: round; }
svg .estimate { stroke: var(--estimate); } svg .live { stroke: var(--live); stroke-width: 1.3; }
svg .truth { stroke: var(--truth); stroke-width: 6; opacity: 0.5; }
svg .segment1 { stroke: var(--segment1); } svg .segment2 { stroke: var(--segment2); } svg .segment3 { stroke: var(--segment3); }
svg .start { fill: var(--card); stroke: var(--ink); stroke-width: 2; } svg .end { fill: var(--ink); }
svg .reference { stroke: var(--ink); stroke-width: 1; stroke-dasharray: 2 3; opacity: 0.7; }
svg .reference-label { fill: var(--ink); paint-order: stroke; stroke: var(--card); stroke-width: 4px; stroke-linejoin: round; }
svg .cursor { stroke: var(--soft); stroke-width: 1; pointer-events: none; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th, td { text-align: left; padding: 5px 10px 5px 0; border-bottom: 1px solid var(--grid); vertical-align: top; }
tr:last-child > * { border-bottom: 0; }
th { color: var(--soft); font-weight: 500; }
td { overflow-wrap: anywhere; }
.numbers td, .numbers th { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; overflow-wrap: normal; }
.numbers td:first-child, .numbers th:first-child { text-align: left; }
.numbers .bar { width: 26%; min-width: 70px; padding-right: 0; }
.bar b { display: block; height: 8px; margin-top: 7px; border-radius: 4px; background: var(--estimate); opacity: 0.85; }
#readout { position: fixed; display: none; pointer-events: none; z-index: 2; padding: 6px 9px; border-radius: 7px;
  background: var(--card); border: 1px solid var(--edge); box-shadow: 0 3px 12px rgb(0 0 0 / 18%); font-size: 12.5px;
  font-variant-numeric: tabular-nums; white-space: nowrap; }
footer { color: var(--soft); font-size: 12.5px; }
@media print { body { background: #fff; } section, .figure { break-inside: avoid; } }
)css";

const char* const kScript = R"js(
(function () {
  var readout = document.getElementById('readout');
  document.querySelectorAll('svg.chart').forEach(function (svg) {
    var data = svg.dataset, series = JSON.parse(data.series);
    var left = +data.left, right = +data.right, length = +data.length;
    var cursor = document.createElementNS(svg.namespaceURI, 'line');
    cursor.setAttribute('class', 'cursor');
    cursor.setAttribute('y1', data.top);
    cursor.setAttribute('y2', data.bottom);
    cursor.style.display = 'none';
    svg.appendChild(cursor);
    function nearest(points, time) {
      var low = 0, high = points.length - 1;
      while (high - low > 1) {
        var middle = (low + high) >> 1;
        if (points[middle][0] < time) low = middle; else high = middle;
      }
      return time - points[low][0] < points[high][0] - time ? points[low] : points[high];
    }
    function hide() { cursor.style.display = 'none'; readout.style.display = 'none'; }
    function show(event) {
      var box = svg.getBoundingClientRect();
      var x = (event.clientX - box.left) / box.width * svg.viewBox.baseVal.width;
      if (x < left || x > right) return hide();
      var time = (x - left) / (right - left) * length;
      cursor.setAttribute('x1', x);
      cursor.setAttribute('x2', x);
      cursor.style.display = '';
      readout.textContent = time.toFixed(2) + ' s';
      series.forEach(function (each) {
        if (!each.p.length) return;
        var row = document.createElement('div');
        row.textContent = each.n + ' ' + nearest(each.p, time)[1];
        readout.appendChild(row);
      });
      readout.style.display = 'block';
      var place = Math.min(event.clientX + 14, innerWidth - readout.offsetWidth - 8);
      readout.style.left = Math.max(8, place) + 'px';
      readout.style.top = Math.max(8, event.clientY - readout.offsetHeight - 12) + 'px';
    }
    svg.addEventListener('pointermove', show);
    svg.addEventListener('pointerdown', show);
    svg.addEventListener('pointerleave', hide);
  });
})();
)js";

}  // namespace unisim::report
