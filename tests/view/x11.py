"""A little of Xlib: find a window, send it keys and buttons, move the pointer, ask it to close. Events are real ones of the X server's queue, marked as sent."""
import ctypes
import ctypes.util
import time

KEY_PRESS, KEY_RELEASE, BUTTON_PRESS, BUTTON_RELEASE, CLIENT_MESSAGE = 2, 3, 4, 5, 33
REVERT_TO_PARENT = 2
CONTROL_MASK = 4


class InputEvent(ctypes.Structure):
    """XKeyEvent and XButtonEvent: the same fields."""
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("root", ctypes.c_ulong),
                ("subwindow", ctypes.c_ulong), ("time", ctypes.c_ulong), ("x", ctypes.c_int), ("y", ctypes.c_int), ("x_root", ctypes.c_int), ("y_root", ctypes.c_int),
                ("state", ctypes.c_uint), ("detail", ctypes.c_uint), ("same_screen", ctypes.c_int)]


class ClientEvent(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p), ("window", ctypes.c_ulong),
                ("message_type", ctypes.c_ulong), ("format", ctypes.c_int), ("data", ctypes.c_long * 5)]


class AnyEvent(ctypes.Union):
    _fields_ = [("input", InputEvent), ("client", ClientEvent), ("room", ctypes.c_long * 24)]


ErrorHandler = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)


class Display:
    def __init__(self):
        self.x = x = ctypes.CDLL("libX11.so.6")
        for name, result in [("XOpenDisplay", ctypes.c_void_p), ("XDefaultRootWindow", ctypes.c_ulong), ("XInternAtom", ctypes.c_ulong), ("XStringToKeysym", ctypes.c_ulong)]:
            getattr(x, name).restype = result
        self.display = ctypes.c_void_p(x.XOpenDisplay(None))
        if not self.display:
            raise RuntimeError("no X display: run this under xvfb-run -a")
        self.root = x.XDefaultRootWindow(self.display)
        self.ignore = ErrorHandler(lambda display, error: 0)  # kept alive: Xlib holds it
        x.XSetErrorHandler(self.ignore)

    def close(self):
        self.x.XCloseDisplay(self.display)

    def _children(self, window):
        root, parent, children, count = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_uint()
        self.x.XQueryTree(self.display, ctypes.c_ulong(window), ctypes.byref(root), ctypes.byref(parent), ctypes.byref(children), ctypes.byref(count))
        found = [children[i] for i in range(count.value)]
        if children:
            self.x.XFree(children)
        return found

    def find(self, title, seconds=60):
        """The window whose title starts with this, once it is there and visible."""
        ends = time.monotonic() + seconds
        while time.monotonic() < ends:
            for window in self._children(self.root):
                name = ctypes.c_char_p()
                if self.x.XFetchName(self.display, ctypes.c_ulong(window), ctypes.byref(name)) and name.value.decode().startswith(title):
                    return window
            time.sleep(0.05)
        raise RuntimeError(f"no window '{title}' after {seconds} s")

    def focus(self, window, seconds=60):
        """Gives it the keyboard, once it is on the screen: until then the server refuses."""
        ends = time.monotonic() + seconds
        focus, revert = ctypes.c_ulong(), ctypes.c_int()
        while time.monotonic() < ends and focus.value != window:
            self.x.XSetInputFocus(self.display, ctypes.c_ulong(window), REVERT_TO_PARENT, ctypes.c_ulong(0))
            self.x.XSync(self.display, 0)
            time.sleep(0.05)
            self.x.XGetInputFocus(self.display, ctypes.byref(focus), ctypes.byref(revert))
        if focus.value != window:
            raise RuntimeError(f"the window takes no focus after {seconds} s")

    def _send(self, window, kind, detail, state=0):
        event = AnyEvent()
        e = event.input
        e.state = state
        e.type, e.display, e.window, e.root, e.detail, e.same_screen = kind, self.display, window, self.root, detail, 1
        self.x.XSendEvent(self.display, ctypes.c_ulong(window), 0, ctypes.c_long(0), ctypes.byref(event))
        self.x.XSync(self.display, 0)

    def _code(self, name):
        return self.x.XKeysymToKeycode(self.display, ctypes.c_ulong(self.x.XStringToKeysym(name.encode())))

    def control(self, window, name, pause=0.15):
        """A key while control is held. Without a pause all of it may reach the window within one of its frames."""
        control, key = self._code("Control_L"), self._code(name)
        for kind, code, state in (KEY_PRESS, control, 0), (KEY_PRESS, key, CONTROL_MASK), (KEY_RELEASE, key, CONTROL_MASK), (KEY_RELEASE, control, CONTROL_MASK):
            self._send(window, kind, code, state)
            time.sleep(pause)

    def key(self, window, name, seconds=0.08):
        """Presses a key (an X keysym's name) for a while."""
        self.press(window, name)
        time.sleep(seconds)
        self.release(window, name)
        time.sleep(0.08)

    def press(self, window, name):
        self._send(window, KEY_PRESS, self._code(name))

    def release(self, window, name):
        self._send(window, KEY_RELEASE, self._code(name))

    def point(self, window, x, y):
        self.x.XWarpPointer(self.display, ctypes.c_ulong(0), ctypes.c_ulong(window), 0, 0, 0, 0, int(x), int(y))
        self.x.XSync(self.display, 0)
        time.sleep(0.12)

    def drag(self, window, start, end, button=1):
        self.point(window, *start)
        self._send(window, BUTTON_PRESS, button)
        time.sleep(0.2)
        self.point(window, *end)
        time.sleep(0.2)
        self._send(window, BUTTON_RELEASE, button)
        time.sleep(0.1)

    def delete(self, window):
        """What a click on the window's close button sends."""
        event = AnyEvent()
        e = event.client
        e.type, e.display, e.window, e.format = CLIENT_MESSAGE, self.display, window, 32
        e.message_type = self.x.XInternAtom(self.display, b"WM_PROTOCOLS", 0)
        e.data[0] = self.x.XInternAtom(self.display, b"WM_DELETE_WINDOW", 0)
        self.x.XSendEvent(self.display, ctypes.c_ulong(window), 0, ctypes.c_long(0), ctypes.byref(event))
        self.x.XSync(self.display, 0)
