// Export of a span, and pictures of the 3D view.
import {$} from './panels.js';

export function download(url, name) {
  const link = document.createElement('a');
  link.href = url;
  link.download = name;
  link.click();
}

const savePicture = (canvas, name) => canvas.toBlob(blob => {
  const url = URL.createObjectURL(blob);
  download(url, name);
  setTimeout(() => URL.revokeObjectURL(url), 10000);
});

const PICTURES = 12;  // of a span in one PNG: four a row

// The 3D view at evenly spaced frames of the span, in one picture.
export async function savePictures(scene, player, [from, to]) {
  const count = Math.min(PICTURES, to - from + 1), columns = Math.min(4, count);
  const width = 480, height = Math.round(width * scene.canvas.height / scene.canvas.width);
  const sheet = document.createElement('canvas');
  sheet.width = columns * width;
  sheet.height = Math.ceil(count / columns) * height;
  const context = sheet.getContext('2d');
  for (let k = 0; k < count; ++k) {
    const frame = Math.round(from + k * (to - from) / Math.max(1, count - 1));
    await player.showFrame(frame);
    const x = k % columns * width, y = Math.floor(k / columns) * height;
    context.drawImage(scene.canvas, x, y, width, height);
    context.fillStyle = '#fff';
    context.font = '16px sans-serif';
    context.fillText(`frame ${frame}`, x + 8, y + height - 10);
  }
  savePicture(sheet, `frames_${from}_${to}.png`);
}

export function connectExport(scene, player, span) {
  for (const button of document.querySelectorAll('[data-export]')) {
    const format = button.dataset.export;
    button.onclick = () => download(`/export?format=${format}&from=${span()[0]}&to=${span()[1]}`, `skeletons.${format}`);
  }
  $('strip_png').onclick = () => savePictures(scene, player, span());
  $('screenshot').onclick = () => savePicture(scene.canvas, 'ossa.png');
}
