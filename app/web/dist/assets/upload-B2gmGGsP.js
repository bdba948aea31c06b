import{A as T,a as x}from"./index-CxHSpJOk.js";function B({label:t,value:e,options:o,onChange:r,children:n}){const a=T(null);return x("div",{class:"tabs",children:[x("div",{ref:a,role:"tablist","aria-label":t,onKeyDown:s=>{const c=s.key==="ArrowRight"?1:s.key==="ArrowLeft"?-1:0;if(c===0)return;s.preventDefault();const h=(o.findIndex(f=>f.value===e)+c+o.length)%o.length,d=o[h];d&&r(d.value),a.current?.children[h]?.focus()},children:o.map(s=>x("button",{type:"button",role:"tab",id:`tab-${s.value}`,"aria-selected":s.value===e,"aria-controls":"tab-panel",tabIndex:s.value===e?0:-1,onClick:()=>r(s.value),children:s.says},s.value))}),x("div",{role:"tabpanel",id:"tab-panel","aria-labelledby":`tab-${e}`,children:n})]})}function E(t){const e=10**Math.floor(Math.log10(t)+1e-9);return([5,2,1].find(r=>r*e<=t*(1+1e-9))??1)*e}function b(t){return t<.1?`${Number((t*1e3).toPrecision(3))} µm`:t>=100?`${Number((t/10).toPrecision(3))} cm`:`${Number(t.toPrecision(3))} mm`}function k(t,e,o){const r=t??1,n=E(o/e*r),a=t===null?`${n} px`:b(n);return{length:n/r*e,says:a}}function W(t,e){if(e===null)return`${t.toFixed(3)} mm, uncertainty not known`;const o=Math.min(6,Math.max(0,1-Math.floor(Math.log10(Math.max(e,1e-6)))));return`${t.toFixed(o)} mm ± ${e.toFixed(o)} mm`}function H(t){const e=o=>String(Number(o.toPrecision(3)));return t>=1?`${e(t)}:1`:`1:${e(1/t)}`}const p=32;function M(t,e){return{x:Math.round(e.width/2-t.x*t.zoom),y:Math.round(e.height/2-t.y*t.zoom)}}function V(t,e,o){const r=M(e,o);return{x:r.x+t.x*e.zoom,y:r.y+t.y*e.zoom}}function g(t,e,o){const r=M(e,o);return{x:(t.x-r.x)/e.zoom,y:(t.y-r.y)/e.zoom}}function R(t,e){const o=Math.min(e.width/t.width,e.height/t.height);return{x:t.width/2,y:t.height/2,zoom:Math.min(Math.max(o,1e-6),p)}}function Y(t,e){return{...t,x:t.x-e.x/t.zoom,y:t.y-e.y/t.zoom}}function q(t,e,o,r){const n=t.zoom*e,a=g(o,t,r);return{x:a.x-(o.x-r.width/2)/n,y:a.y-(o.y-r.height/2)/n,zoom:n}}function K(t,e){const o=Math.log2(t);return 2**(e>0?Math.floor(o+1e-6)+1:Math.ceil(o-1e-6)-1)}function Z(t,e,o){const r=Math.min(R(e,o).zoom/4,1);return{x:m(t.x,0,e.width),y:m(t.y,0,e.height),zoom:m(t.zoom,r,p)}}function m(t,e,o){return Math.min(Math.max(t,e),o)}const w=5;function A(t){const e=Math.hypot(t.x,t.y),o=Math.cos(w*Math.PI/180),r=e>o?o/e:1,n=t.x*r,a=-t.y*r;return[n,a,Math.sqrt(1-n*n-a*a)]}function z(t){return{x:t[0],y:-t[1]}}function P(t){return Math.asin(m(t[2],-1,1))*180/Math.PI}function D(t){const e=Math.atan2(t[1],t[0])*180/Math.PI;return Math.round(e<0?e+360:e)%360}const F=["the right","the upper right","the top","the upper left","the left","the lower left","the bottom","the lower right"];function j(t){const e=Math.round(P(t));return e>=88?"from straight above":`from ${F[Math.round(D(t)/45)%8]??""}, ${e} degrees high`}function J(t,e){const o=z(t);return A({x:o.x+e.x,y:o.y+e.y})}function Q(t,e){return t.every((o,r)=>Math.abs(o-(e[r]??0))<.001)}function _(t,e){const o=r=>Math.ceil(r/2**e);return{width:o(t.size.width),height:o(t.size.height)}}function S(t,e){const o=_(t,e.level);return{width:Math.min(t.side,o.width-e.column*t.side),height:Math.min(t.side,o.height-e.row*t.side)}}function I(t,e){const o=2**e.level,r=S(t,e);return{x:e.column*t.side*o,y:e.row*t.side*o,width:r.width*o,height:r.height*o}}function tt(t,e){return m(Math.floor(-Math.log2(e)+1e-6),0,t.levels-1)}function L(t,e,o,r,n){const a=t.side*2**e,i=_(t,e),s=g({x:0,y:0},o,r),c=g({x:r.width,y:r.height},o,r),h=Math.ceil(i.width/t.side),d=Math.ceil(i.height/t.side),f=[],v=u=>Math.max(0,Math.floor(u/a)),y=(u,l)=>Math.min(l,Math.ceil(u/a));for(let u=v(s.y-n.y);u<y(c.y-n.y,d);++u)for(let l=v(s.x-n.x);l<y(c.x-n.x,h);++l)f.push({level:e,column:l,row:u});return f}function U(t,e,o){const r=I(t,e);return Math.hypot(r.x+r.width/2-o.x,r.y+r.height/2-o.y)}function et(t,e,o,r,n){const a=new Map;for(const i of n)for(const s of L(t,e,o,r,i)){const c=`${s.column}_${s.row}`,h=U(t,s,{x:o.x-i.x,y:o.y-i.y});h<(a.get(c)?.far??1/0)&&a.set(c,{tile:s,far:h})}return[...a.values()].sort((i,s)=>i.far-s.far).map(({tile:i})=>i)}const $={1:[0],2:[0,1],3:[-1,0,1]};function ot(t,e){const o=$[e];return o.flatMap(r=>o.map(n=>({x:n*t.width,y:r*t.height})))}function rt(t,e,o,r){const n=M(o,r),a=Math.round(n.x+(e.x+t.x)*o.zoom),i=Math.round(n.y+(e.y+t.y)*o.zoom),s=Math.round(n.x+(e.x+t.x+t.width)*o.zoom),c=Math.round(n.y+(e.y+t.y+t.height)*o.zoom);return{x:a,y:i,width:s-a,height:c-i}}class nt{constructor(e,o,r){if(this.gl=e,this.program=e.createProgram(),this.attach(e.VERTEX_SHADER,o),this.attach(e.FRAGMENT_SHADER,r),e.linkProgram(this.program),!e.isContextLost()&&!e.getProgramParameter(this.program,e.LINK_STATUS))throw new Error(e.getProgramInfoLog(this.program)??"A program does not link.")}program;places=new Map;use(){this.gl.useProgram(this.program)}at(e){const o=this.places.get(e);if(o!==void 0)return o;const r=this.gl.getUniformLocation(this.program,e);return this.places.set(e,r),r}attach(e,o){const{gl:r}=this,n=r.createShader(e);if(n){if(r.shaderSource(n,o),r.compileShader(n),!r.isContextLost()&&!r.getShaderParameter(n,r.COMPILE_STATUS))throw new Error(r.getShaderInfoLog(n)??"A shader does not compile.");r.attachShader(this.program,n),r.deleteShader(n)}}}const at=`#version 300 es
uniform vec4 rect;
out vec2 uv;
void main() {
  uv = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(rect.xy + uv * rect.zw, 0.0, 1.0);
}`,st=`#version 300 es
precision highp float;
uniform sampler2D tile;
uniform vec2 scale;
in vec2 uv;
out vec4 value;
void main() {
  value = vec4(texture(tile, uv).rgb * scale.x + scale.y, 1.0);
}`,it=`#version 300 es
precision highp float;
uniform sampler2D tile;
in vec2 uv;
out vec4 value;
void main() {
  value = vec4(texture(tile, uv).r);
}`,N={color:"vec4 map = texelFetch(color, at, 0); bool is_there = map.a > 0.0; vec3 seen = srgb(gain * map.rgb);",normal:"vec4 map = texelFetch(normal, at, 0); bool is_there = map.a > 0.0; vec3 seen = map.rgb * 0.5 + 0.5;",relit:`vec4 map = texelFetch(normal, at, 0); vec4 rho = texelFetch(color, at, 0);
  bool is_there = map.a * rho.a > 0.0; vec3 seen = srgb(gain * rho.rgb * max(0.0, dot(map.xyz, light)));`,scalar:`vec4 map = texelFetch(scalar, at, 0); bool is_there = map.a > 0.0;
  vec3 seen = texture(heat, vec2((clamp((map.r - range.x) / (range.y - range.x), 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;`,flags:`vec4 map = texelFetch(normal, at, 0); vec4 rho = texelFetch(color, at, 0);
  bool is_there = map.a * rho.a > 0.0; vec3 lit = gain * rho.rgb * max(0.0, dot(map.xyz, light));
  vec3 seen = vec3(0.4 * srgb(vec3(dot(lit, vec3(0.2126, 0.7152, 0.0722)))).r);`},O=`
  vec4 low = texelFetch(flags_low, at, 0); vec4 high = texelFetch(flags_high, at, 0);
  vec3 mixed = vec3(0.0); float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    mixed += low[i] * bit_colours[i] + high[i] * bit_colours[i + 4];
    sum += low[i] + high[i];
  }
  if (sum > 0.0) seen = mix(seen, mixed / sum, min(sum, 1.0) * 0.9);`;function ct(t,e){return`#version 300 es
precision highp float;
uniform sampler2D normal, color, scalar, heat, flags_low, flags_high;
uniform vec3 light, bit_colours[8];
uniform float gain;
uniform vec2 range;
uniform int step;
out vec4 value;
vec3 srgb(vec3 linear) {
  vec3 held = clamp(linear, 0.0, 1.0);
  return mix(12.92 * held, 1.055 * pow(held, vec3(1.0 / 2.4)) - 0.055, greaterThan(held, vec3(0.0031308)));
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) * step;
  ${N[t]}
  ${e?O:""}
  value = vec4(is_there ? seen : vec3(0.02), 1.0);
}`}const C=t=>({normal:[t.RGB10_A2,t.RGBA,t.UNSIGNED_INT_2_10_10_10_REV],color:[t.RGB16F,t.RGB,t.HALF_FLOAT],scalar:[t.R16F,t.RED,t.HALF_FLOAT],flags:[t.R8,t.RED,t.UNSIGNED_BYTE]});function X(t,e){return t==="normal"?new Uint32Array(e):t==="flags"?new Uint8Array(e):new Uint16Array(e)}const ht=[1023/511,-1];function ut(t,e,o,r){const[n,a,i]=C(t)[e];t.texImage2D(t.TEXTURE_2D,0,n,o.width,o.height,0,a,i,X(e,r))}function lt(t,e,o){const r=t.createTexture();return t.bindTexture(t.TEXTURE_2D,r),t.texParameteri(t.TEXTURE_2D,t.TEXTURE_MIN_FILTER,e),t.texParameteri(t.TEXTURE_2D,t.TEXTURE_MAG_FILTER,e),t.texParameteri(t.TEXTURE_2D,t.TEXTURE_WRAP_S,o),t.texParameteri(t.TEXTURE_2D,t.TEXTURE_WRAP_T,o),r}export{K as A,R as B,st as C,Z as D,ht as N,nt as P,at as R,B as T,it as a,_ as b,j as c,A as d,et as e,ut as f,ot as g,tt as h,Q as i,ct as j,rt as k,b as l,I as m,J as n,m as o,z as p,Y as q,E as r,lt as s,S as t,g as u,V as v,k as w,H as x,W as y,q as z};
