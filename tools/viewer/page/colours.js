// Colours of what is shown, the same in 3D and in the pictures.

// People, told apart by the colour-blind, too (Okabe and Ito 2008), by id.
export const PEOPLE = ['#56b4e9', '#e69f00', '#009e73', '#f0e442', '#cc79a7', '#d55e00'];
export const OVERLAYS = ['#ff5ccd', '#7fc31c', '#c9b18a'];
export const THINGS = '#b0a08a';  // of a scene
export const LAYERS = {refined: '#a47cf0', raw: '#9aa0a8'};
export const NEAR_MM = 500;
export const FAR_MM = 5000;

export const personColour = id => PEOPLE[(id - 1 + PEOPLE.length) % PEOPLE.length];

const bytes = hex => [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16));

// Turbo (Mikhailov 2019), its polynomial approximation; near is red, far is blue.
function turbo(x) {
  const powers = [1, x, x * x, x ** 3, x ** 4, x ** 5];
  const channel = factors => 255 * factors.reduce((sum, factor, i) => sum + factor * powers[i], 0);
  return [
    channel([0.13572138, 4.6153926, -42.66032258, 132.13108234, -152.94239396, 59.28637943]),
    channel([0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604]),
    channel([0.1066733, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973]),
  ];
}

function hue(share, light) {
  const channel = shift => {
    const k = (shift + share * 12) % 12;
    return 255 * (light - Math.min(light, 1 - light) * Math.max(-1, Math.min(k - 3, 9 - k, 1)));
  };
  return [channel(0), channel(8), channel(4)];
}

// Neighbours of the list of parts lie next to each other on the body: their hues must not.
const partColour = part => hue((part * 11 % 31) / 31, part % 2 ? 0.62 : 0.48);

// Three rows of 256 colours (RGBA): by depth, by person, by body part.
function makePalette() {
  const palette = new Uint8Array(3 * 256 * 4);
  const set = (row, i, rgb) => palette.set([...rgb.map(c => Math.max(0, Math.min(255, Math.round(c)))), 255], (row * 256 + i) * 4);
  for (let i = 0; i < 256; ++i) {
    set(0, i, turbo(1 - i / 255));
    set(1, i, i === 0 ? [92, 99, 110] : bytes(personColour(i)).map(c => 0.55 * c));  // their skeletons are brighter
    set(2, i, i === 0 ? [92, 99, 110] : i > 31 ? [220, 220, 220] : partColour(i));
  }
  return palette;
}
export const PALETTE = makePalette();

export const depthIndex = mm => Math.round(255 * Math.max(0, Math.min(1, (mm - NEAR_MM) / (FAR_MM - NEAR_MM))));
