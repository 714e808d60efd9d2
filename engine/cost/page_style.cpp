#include <fmt/format.h>

#include "cost/page.h"
#include "cost/svg.h"

namespace burnish::cost {
namespace {

constexpr std::string_view kStyle = R"(*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%;scroll-padding-top:56px}
body{margin:0;background:var(--ground);color:var(--ink);font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"Noto Sans","Liberation Sans","DejaVu Sans",Arial,sans-serif;font-variant-numeric:tabular-nums;overflow-wrap:anywhere}
.wide,main{max-width:1128px;margin:0 auto;padding:0 24px}
h1{font-size:30px;line-height:1.2;margin:0 0 16px;font-weight:650;letter-spacing:-.01em}
h2{font-size:21px;line-height:1.3;margin:0 0 10px;font-weight:650}
h3{font-size:16px;margin:28px 0 6px;font-weight:650}
h4{font-size:13px;margin:14px 0 4px;font-weight:600}
p{margin:6px 0 12px;max-width:78ch}
a{color:var(--time);text-decoration-thickness:1px;text-underline-offset:2px}
code{font:12.5px/1.5 ui-monospace,"SFMono-Regular",Menlo,Consolas,"DejaVu Sans Mono",monospace}
button{font:inherit;font-size:13px;color:var(--ink);background:var(--panel);border:1px solid var(--rule);border-radius:6px;padding:3px 11px;cursor:pointer}
button:hover{border-color:var(--dim)}
:focus-visible{outline:2px solid var(--time);outline-offset:2px;border-radius:3px}
section{padding:34px 0 8px;border-top:1px solid var(--rule);margin-top:26px}
.soft,.what{color:var(--soft);font-weight:400}
.skip{position:absolute;left:-999px}
.skip:focus{left:12px;top:8px;z-index:9;background:var(--ground);padding:4px 8px}
nav{position:sticky;top:0;z-index:5;background:var(--ground);border-bottom:1px solid var(--rule)}
nav .wide{display:flex;gap:4px 18px;align-items:center;min-height:44px;overflow-x:auto;white-space:nowrap}
nav a{color:var(--soft);text-decoration:none;font-size:13.5px;padding:4px 0}
nav a:hover{color:var(--ink)}
#theme{margin-left:auto}
header{padding-top:36px!important}
.eyebrow{margin:0 0 4px;color:var(--soft);font-size:13px;letter-spacing:.04em;text-transform:uppercase}
.facts{display:grid;grid-template-columns:repeat(auto-fill,minmax(240px,1fr));gap:10px 28px;margin:0 0 16px}
.facts dt{font-size:12px;color:var(--soft)}
.facts dd{margin:0;font-size:14px}
.command{display:flex;gap:10px;align-items:flex-start;background:var(--panel);border-radius:6px;padding:9px 12px}
.command code{flex:1;min-width:0}
.caution a,.mark.warn{color:var(--error)}
.tiles{list-style:none;display:grid;grid-template-columns:repeat(auto-fit,minmax(158px,1fr));gap:1px;padding:1px;margin:16px 0 20px;background:var(--rule);border-radius:8px;overflow:hidden}
.tiles li{background:var(--ground);padding:12px 14px 10px;display:flex;flex-direction:column}
.tiles .name{font-size:12.5px;color:var(--soft)}
.tiles .value{font-size:21px;font-weight:600;line-height:1.35}
.tiles .hint,.tiles .other{font-size:12px;color:var(--soft)}
.tiles .other{margin-top:6px;padding-top:5px;border-top:1px solid var(--grid)}
.triptych{display:grid;grid-template-columns:repeat(3,minmax(0,1fr));gap:6px 12px;margin:14px 0}
.triptych h4{grid-column:1/-1;margin:6px 0 0;font-size:13.5px}
figure{margin:0;min-width:0}
figcaption{font-size:12px;color:var(--soft);margin-top:3px}
.picture{display:block;width:100%;height:auto;border-radius:3px;background:#000}
.nopicture{display:flex;min-height:90px;align-items:center;justify-content:center;font-size:12px;color:var(--soft);background:var(--panel);border-radius:3px}
.flip{position:relative;display:block;cursor:pointer}
.flip input{position:absolute;opacity:0;inset:0;margin:0;width:100%;height:100%;cursor:pointer;z-index:1}
.flip:focus-within{outline:2px solid var(--time);outline-offset:2px;border-radius:3px}
.flip .two{display:none}
.flip input:checked~.two{display:block}
.flip input:checked~.one{display:none}
.flip .tag{position:absolute;left:6px;bottom:6px;max-width:calc(100% - 12px);background:rgba(0,0,0,.66);color:#fff;font-size:11px;line-height:1.35;padding:1px 7px;border-radius:3px}
.wipe{position:relative;display:block}
.wipe .over{position:absolute;inset:0}
input[type=range]{accent-color:var(--time);width:100%;margin:4px 0 0}
.store{position:absolute}
.plotbox,.scroll{overflow-x:auto;margin:10px 0}
.plotbox>.plot{display:block;width:100%;min-width:720px;max-width:1080px;height:auto}
.scale{display:flex;flex-wrap:wrap;gap:2px 14px;align-items:center;font-size:12px;color:var(--soft);margin:8px 0 14px}
.scale .plot{max-width:100%;height:auto;flex:none}
table{border-collapse:collapse;font-size:13px;min-width:100%}
th,td{padding:5px 10px;text-align:right;vertical-align:baseline;border-bottom:1px solid var(--grid);white-space:nowrap;overflow-wrap:normal}
th{font-weight:600;text-align:left}
thead th{color:var(--soft);font-weight:500;font-size:12px;white-space:normal;vertical-align:bottom;border-bottom-color:var(--rule)}
th.n{text-align:right}
th[scope=colgroup]{text-align:center;border-bottom:1px solid var(--rule)}
td.t{text-align:left;white-space:normal;min-width:110px;max-width:420px;overflow-wrap:anywhere}
tbody th{min-width:124px;max-width:300px;white-space:normal;overflow-wrap:anywhere}
tr.note td{text-align:left;white-space:normal;overflow-wrap:anywhere;color:var(--soft);font-size:12.5px;padding-top:0}
tr:has(+.note)>*{border-bottom-color:transparent}
.rungs th,.rungs td{padding:5px 7px}
.range{font-size:11px;color:var(--soft)}
tr.base>*{background:var(--wash)}
tr.lesser>th,tr.lesser>td{color:var(--soft)}
.mark{font-size:11px;font-weight:500;color:var(--soft);border:1px solid var(--rule);border-radius:3px;padding:0 4px;white-space:nowrap}
.mark.exact{color:var(--best)}
.mark.base{color:var(--time)}
.mark.chosen{color:var(--budget)}
details{margin:6px 0}
summary{cursor:pointer;color:var(--soft);font-size:13px;padding:3px 0;width:fit-content;max-width:100%}
summary:hover{color:var(--ink)}
.term{border-top:1px solid var(--grid);margin-top:22px}
.term h3{margin-top:18px}
.cards{display:grid;grid-template-columns:repeat(auto-fill,minmax(290px,1fr));gap:14px}
.card{border:1px solid var(--rule);border-radius:8px;padding:4px 16px 10px;min-width:0}
.card h3{margin-top:10px}
.big{font-size:20px;font-weight:600;margin:2px 0}
.settings{margin:6px 0;padding:0;list-style:none;display:flex;flex-wrap:wrap;gap:4px}
.settings li{background:var(--panel);border-radius:4px;padding:0 7px;font-size:12.5px;max-width:100%}
.words{display:grid;grid-template-columns:repeat(auto-fill,minmax(300px,1fr));gap:12px 32px;margin:8px 0}
.words dt{font-weight:600;font-size:13.5px}
.words dd{margin:0;font-size:13px;color:var(--soft)}
.warnings{padding-left:20px}
footer{border-top:1px solid var(--rule);margin-top:34px;padding:14px 0 40px;font-size:12.5px;color:var(--soft)}
.point,.row{outline:none}
.point:hover .dot,.point:focus .dot,.point:hover .other{stroke:var(--ink);stroke-width:2}
.point:focus-visible .dot{stroke-width:3}
#tip{position:fixed;z-index:10;max-width:min(340px,calc(100vw - 16px));background:var(--ink);color:var(--ground);font-size:12.5px;line-height:1.4;padding:6px 9px;border-radius:5px;pointer-events:none;left:0;top:0}
#tip[hidden]{display:none}
@media(max-width:640px){.wide,main{padding:0 14px}h1{font-size:24px}.triptych{grid-template-columns:repeat(2,minmax(0,1fr))}.triptych:not(.large) .middle{display:none}.triptych.large{grid-template-columns:minmax(0,1fr)}.facts{grid-template-columns:repeat(auto-fill,minmax(150px,1fr))}.tiles{grid-template-columns:repeat(2,1fr)}}
@media print{nav,button,.skip,.tools{display:none!important}.wide,main{max-width:none;padding:0}.plotbox>.plot{min-width:0}figure,.card,.plotbox,tr{break-inside:avoid}h2,h3,h4{break-after:avoid}.scroll,.plotbox{overflow:visible}table{font-size:9px}th,td,.rungs th,.rungs td{padding:2px 4px}.picture,.tiles,tr.base>*,rect{print-color-adjust:exact;-webkit-print-color-adjust:exact}}
)";

std::string variables(bool dark) {
  std::string out;
  for (const ThemeColour& c : themeColours()) out += fmt::format("--{}:{};", c.name, dark ? c.dark : c.light);
  return out + (dark ? "color-scheme:dark" : "color-scheme:light");
}

}  // namespace

std::string pageStyle() {
  const std::string light = variables(false), dark = variables(true);
  std::string out = fmt::format(":root{{{}}}\n@media screen and (prefers-color-scheme:dark){{:root:not([data-theme=light]){{{}}}}}\n@media screen{{:root[data-theme=dark]{{{}}}}}\n", light, dark, dark);
  return out + std::string(kStyle) + plotStyle(true);
}

}  // namespace burnish::cost
