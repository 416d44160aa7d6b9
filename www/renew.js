// Has the service worker keep the page's files, and says when a newer Sinew is there.

/** Shows a sentence over the page, with a button that does something. */
function say(sentence, act) {
  document.getElementById('renew')?.remove();
  const notice = document.createElement('aside');
  notice.id = 'renew';
  notice.setAttribute('role', 'status');
  const words = document.createElement('span');
  words.textContent = sentence;
  const reload = document.createElement('button');
  reload.textContent = 'Reload';
  reload.addEventListener('click', act);
  const later = document.createElement('button');
  later.className = 'quiet';
  later.textContent = 'Later';
  later.addEventListener('click', () => notice.remove());
  notice.append(words, reload, later);
  document.body.append(notice);
}

/** Registers the service worker, where there can be one and the visitor does not save data. */
export async function renew() {
  const { serviceWorker, connection } = navigator;
  if (!serviceWorker || connection?.saveData) return;
  let isFirst = !serviceWorker.controller;
  let reloads = false;
  serviceWorker.addEventListener('controllerchange', () => {
    if (reloads) location.reload();
    else if (!isFirst) say('Sinew was renewed in another tab.', () => location.reload());
    isFirst = false;
  });
  let registration;
  try {
    registration = await serviceWorker.register('./offline.js', { updateViaCache: 'none' });
  } catch (reason) {
    // Some browsers allow none in private windows; the page needs the net then.
    console.info(`Sinew will not work without a net: ${reason?.message ?? reason}`);
    return;
  }
  const offer = (worker) =>
    say('A newer Sinew is here.', () => {
      reloads = true;
      worker.postMessage('renew');
    });
  if (registration.waiting && serviceWorker.controller) offer(registration.waiting);
  registration.addEventListener('updatefound', () => {
    const worker = registration.installing;
    worker?.addEventListener('statechange', () => {
      if (worker.state === 'installed' && serviceWorker.controller) offer(worker);
    });
  });
}
