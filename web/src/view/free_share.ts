// How much of the view's width and height the panels leave free, about its middle.
export type Share = { width: number; height: number };

export function freeShare(element: HTMLElement): Share {
  const view = element.getBoundingClientRect();
  const share = { width: 1, height: 1 };
  for (const panel of document.querySelectorAll('.panel')) {
    const { left, right, top, bottom, width, height } = panel.getBoundingClientRect();
    // From the middle to the nearer side, both ways; what lies across the view is above or below.
    if (width < view.width * 0.7) share.width = Math.min(share.width, Math.max(Math.abs((left + right) / 2 - view.left - view.width / 2) * 2 - width, 0) / view.width);
    else if (height < view.height * 0.3) share.height = Math.min(share.height, Math.max(Math.abs((top + bottom) / 2 - view.top - view.height / 2) * 2 - height, 0) / view.height);
  }
  return { width: Math.max(share.width, 0.3), height: Math.max(share.height, 0.3) };
}
