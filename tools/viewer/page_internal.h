#pragma once

namespace ossa::viewer {

/// The page: plain HTML and canvas, nothing fetched from elsewhere.
inline constexpr const char* kPage = R"html(<!doctype html>
<html lang="en"><meta charset="utf-8"><title>ossa</title>
<style>
 body{margin:0;background:#14161a;color:#cdd3dd;font:14px/1.5 sans-serif}
 header{padding:.6em 1em}main{display:flex;flex-wrap:wrap;gap:1em;padding:0 1em}
 canvas{background:#000;max-width:100%;border-radius:4px}figure{margin:0}
</style>
<header><b>ossa</b> <span id="say">waiting for frames</span></header>
<main><figure><canvas id="front" width="640" height="480"></canvas>
<figcaption>depth and skeletons</figcaption></figure>
<figure><canvas id="top" width="480" height="480"></canvas>
<figcaption>from above, 6 m deep</figcaption></figure></main>
<script>
const parents={Spine:'HipCenter',ShoulderCenter:'Spine',Head:'ShoulderCenter',
 ShoulderLeft:'ShoulderCenter',ElbowLeft:'ShoulderLeft',WristLeft:'ElbowLeft',HandLeft:'WristLeft',
 ShoulderRight:'ShoulderCenter',ElbowRight:'ShoulderRight',WristRight:'ElbowRight',
 HandRight:'WristRight',HipLeft:'HipCenter',KneeLeft:'HipLeft',AnkleLeft:'KneeLeft',
 FootLeft:'AnkleLeft',HipRight:'HipCenter',KneeRight:'HipRight',AnkleRight:'KneeRight',
 FootRight:'AnkleRight'};
const colours=['#50c8ff','#78ff78','#ffa05a','#c878ff','#ffff6e','#6e82ff'];
const front=document.getElementById('front').getContext('2d');
const above=document.getElementById('top').getContext('2d');
const small=document.createElement('canvas');
function depth(bytes,w,h){
 small.width=w;small.height=h;const c=small.getContext('2d'),im=c.createImageData(w,h);
 for(let i=0;i<w*h;i++){im.data[4*i]=im.data[4*i+1]=im.data[4*i+2]=bytes[i];im.data[4*i+3]=255;}
 c.putImageData(im,0,0);front.drawImage(small,0,0,640,480);}
function lines(c,bodies,at){
 for(const b of bodies){c.strokeStyle=c.fillStyle=colours[(b.id-1)%6];
  for(const [child,parent] of Object.entries(parents)){
   const a=b.joints[child],p=b.joints[parent];if(!a||!p)continue;
   c.globalAlpha=a.state==='tracked'?1:.35;c.lineWidth=a.state==='tracked'?4:2;
   const s=at(a.p),e=at(p.p);c.beginPath();c.moveTo(...s);c.lineTo(...e);c.stroke();}
  c.globalAlpha=1;const h=b.joints.Head;if(h)c.fillText('person '+b.id,...at(h.p));}}
let shown=-1;
async function step(){
 try{const r=await (await fetch('/frame')).json();
  if(r.number!==shown){shown=r.number;const k=r.camera;
   depth(new Uint8Array(await (await fetch('/depth')).arrayBuffer()),r.width,r.height);
   lines(front,r.skeletons.bodies,p=>[(k.cx-k.fx*p[0]/p[2])*640/k.width,
    (k.cy-k.fy*p[1]/p[2])*480/k.height]);
   above.clearRect(0,0,480,480);above.strokeStyle='#333';above.lineWidth=1;
   for(let m=0;m<6;m++){above.beginPath();above.moveTo(0,480-80*m);above.lineTo(480,480-80*m);
    above.stroke();}
   lines(above,r.skeletons.bodies,p=>[240-80*p[0],480-80*p[2]]);
   document.getElementById('say').textContent=`frame ${r.skeletons.frame}, `+
    `${r.skeletons.time_s.toFixed(2)} s, ${r.skeletons.bodies.length} people`;}
 }catch(e){document.getElementById('say').textContent='no connection';}
 setTimeout(step,33);}
step();
</script></html>
)html";

}  // namespace ossa::viewer
