// A hand with a mouse or a finger, which draws on the picture of an open page.

/** Points along a stroke through a few places, as shares of the picture. */
export function through(places, steps = 5) {
  const points = [];
  for (let i = 0; i + 1 < places.length; i++) {
    for (let k = 0; k < steps; k++) {
      const at = (j) => places[Math.min(Math.max(j, 0), places.length - 1)];
      const [a, b, c, d] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
      const t = k / steps;
      points.push([0, 1].map((x) => {
        const [p, q, r, s] = [a, b, c, d].map((place) => place[x]);
        return 0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - s) * t * t + (3 * q - p - 3 * r + s) * t ** 3);
      }));
    }
  }
  points.push(places[places.length - 1]);
  return points;
}

/** A hand with a mouse or a finger on an open page. */
export class Hand {
  gestures = 0;

  constructor(sinew, touch) {
    this.sinew = sinew;
    this.touch = touch;
  }

  static async on(sinew, touch) {
    const hand = new Hand(sinew, touch);
    if (touch) hand.session = await sinew.page.context().newCDPSession(sinew.page);
    return hand;
  }

  /** Where places of the picture are on the screen. To ask where the picture is takes some frames, so it is asked once a stroke. */
  async at(...places) {
    const picture = await this.sinew.place('picture');
    return places.map(([x, y]) => [picture.x + x * picture.w, picture.y + y * picture.h]);
  }

  /** A stroke through places of the picture, shares of its width and height. */
  async stroke(...places) {
    return this.along(await this.at(...through(places)));
  }

  /** A stroke through places of the screen. */
  async along(points) {
    const { revision } = await this.sinew.status();
    this.gestures += 1;
    if (this.touch) {
      const send = (type, touches) =>
        this.session.send('Input.dispatchTouchEvent', {
          type,
          touchPoints: touches.map(([x, y], id) => ({ x, y, id })),
        });
      await send('touchStart', [points[0]]);
      for (const point of points.slice(1)) await send('touchMove', [point]);
      await send('touchEnd', []);
    } else {
      const { mouse } = this.sinew.page;
      await mouse.move(...points[0]);
      await mouse.down();
      for (const point of points.slice(1)) await mouse.move(...point);
      await mouse.up();
    }
    return this.sinew.until((status) => status.revision > revision);
  }

  async tap(place) {
    return this.along(await this.at(place));
  }

  /** Presses a widget. */
  async press(name) {
    const { x, y, w, h } = await this.sinew.place(name);
    if (this.touch) await this.sinew.page.touchscreen.tap(x + w / 2, y + h / 2);
    else await this.sinew.page.mouse.click(x + w / 2, y + h / 2);
  }
}

