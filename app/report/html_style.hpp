#pragma once

namespace torsion::engine {

/// The report's style sheet, for the screen and for paper.
inline constexpr const char* kReportStyle = R"css(
html { font-size: 16px; }
body { font: 1rem/1.45 "DejaVu Sans", "Helvetica Neue", Arial, sans-serif; color: #111;
       max-width: 76rem; margin: 2rem auto; padding: 0 1.5rem; }
h1 { font-size: 1.9rem; margin-bottom: 0.2rem; }
h2 { font-size: 1.35rem; border-top: 1px solid #999; padding-top: 1.2rem; margin-top: 2.5rem; }
h3 { font-size: 1.05rem; }
p, dd { max-width: 52rem; }
dt { font-weight: bold; } dd { margin: 0 0 0.5rem 1.5rem; }
table { border-collapse: collapse; font-size: 0.85rem; margin: 1rem 0; }
caption { text-align: left; font-weight: bold; padding-bottom: 0.3rem; }
th, td { padding: 0.15rem 0.7rem; text-align: right; border-bottom: 1px solid #ddd;
         font-variant-numeric: tabular-nums; }
th { border-bottom: 2px solid #444; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; white-space: nowrap; }
td.best { font-weight: bold; }
tr.group td, tr.group th { border-top: 1px solid #888; }
.wide { overflow-x: auto; }
.overview table { font-size: 0.78rem; }
.overview th, .overview td { padding: 0.15rem 0.3rem; }
.figures { display: grid; grid-template-columns: repeat(2, 1fr); gap: 1rem 1.5rem; }
figure { margin: 0; break-inside: avoid; }
figure svg, figure img { width: 100%; height: auto; display: block; }
figcaption { font-size: 0.85rem; color: #333; margin-top: 0.2rem; }
.intro { display: grid; grid-template-columns: 3fr 2fr; gap: 1.5rem; align-items: start; }
.intro p:first-child { margin-top: 0; }
details.run { margin: 0.8rem 0; }
summary { cursor: pointer; }
iframe { width: 100%; height: 32rem; border: 1px solid #999; margin-top: 0.5rem; }
@media screen and (max-width: 50rem) { .figures, .intro { grid-template-columns: 1fr; } }
@media print {
  @page { size: A4; margin: 15mm; }
  html { font-size: 8.5pt; }
  body { margin: 0; padding: 0; max-width: none; }
  h2 { break-after: avoid; }
  section.case { break-before: page; }
  section.case h2 { margin-top: 0; border-top: none; }
  .figures { gap: 0.4rem 1rem; }
  table { font-size: 0.8rem; margin: 0.5rem 0; break-inside: avoid; }
  th, td { padding: 0.1rem 0.35rem; }
  .wide { overflow: visible; }
  details.run { display: none; }
}
)css";

}  // namespace torsion::engine
