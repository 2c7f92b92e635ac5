<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
<context>
    <name>Commands</name>
    <message>
        <source>This case has not been flattened.</source>
        <translation>Für diesen Fall gibt es keine Abwicklung.</translation>
    </message>
    <message>
        <source>Cases of the server…</source>
        <translation>Fälle auf dem Server…</translation>
    </message>
    <message>
        <source>Cases</source>
        <translation>Fälle</translation>
    </message>
    <message>
        <source>Save the picture…</source>
        <translation>Bild speichern…</translation>
    </message>
    <message>
        <source>Copy the picture</source>
        <translation>Bild kopieren</translation>
    </message>
    <message>
        <source>Quit</source>
        <translation>Beenden</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Rückgängig</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>Wiederherstellen</translation>
    </message>
    <message>
        <source>Enlarge this pane, and back</source>
        <translation>Diese Ansicht vergrößern und zurück</translation>
    </message>
    <message>
        <source>Layout: endoscopic reading</source>
        <translation>Layout: endoskopische Befundung</translation>
    </message>
    <message>
        <source>Layout: slices first</source>
        <translation>Layout: Schichten zuerst</translation>
    </message>
    <message>
        <source>Layout: flattened reading</source>
        <translation>Layout: Befundung der Abwicklung</translation>
    </message>
    <message>
        <source>Layout: two monitors</source>
        <translation>Layout: zwei Monitore</translation>
    </message>
    <message>
        <source>Save this layout…</source>
        <translation>Dieses Layout speichern…</translation>
    </message>
    <message>
        <source>Full screen</source>
        <translation>Vollbild</translation>
    </message>
    <message>
        <source>Fly forward, pause</source>
        <translation>Vorwärts fliegen, anhalten</translation>
    </message>
    <message>
        <source>Fly backward, pause</source>
        <translation>Rückwärts fliegen, anhalten</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Anhalten</translation>
    </message>
    <message>
        <source>1 mm forward</source>
        <translation>1 mm vorwärts</translation>
    </message>
    <message>
        <source>1 mm backward</source>
        <translation>1 mm rückwärts</translation>
    </message>
    <message>
        <source>10 mm forward</source>
        <translation>10 mm vorwärts</translation>
    </message>
    <message>
        <source>10 mm backward</source>
        <translation>10 mm rückwärts</translation>
    </message>
    <message>
        <source>To the rectum</source>
        <translation>Zum Rektum</translation>
    </message>
    <message>
        <source>To the cecum</source>
        <translation>Zum Zökum</translation>
    </message>
    <message>
        <source>Go to a place along the path…</source>
        <translation>Zu einer Stelle auf dem Pfad gehen…</translation>
    </message>
    <message>
        <source>Faster</source>
        <translation>Schneller</translation>
    </message>
    <message>
        <source>Slower</source>
        <translation>Langsamer</translation>
    </message>
    <message>
        <source>Turn round</source>
        <translation>Umkehren</translation>
    </message>
    <message>
        <source>Back to the path, straight ahead</source>
        <translation>Zurück zum Pfad, geradeaus</translation>
    </message>
    <message>
        <source>Free flight: W A S D, Q E down and up</source>
        <translation type="vanished">Freier Flug: W A S D, mit Q E ab und auf</translation>
    </message>
    <message>
        <source>Fisheye, which sees all around</source>
        <translation>Fischauge mit Rundumsicht</translation>
    </message>
    <message>
        <source>Wider field of view</source>
        <translation>Größeres Blickfeld</translation>
    </message>
    <message>
        <source>Narrower field of view</source>
        <translation>Kleineres Blickfeld</translation>
    </message>
    <message>
        <source>Window: colon</source>
        <translation>Fenster: Kolon</translation>
    </message>
    <message>
        <source>Window: soft tissue</source>
        <translation>Fenster: Weichteile</translation>
    </message>
    <message>
        <source>Window: lung</source>
        <translation>Fenster: Lunge</translation>
    </message>
    <message>
        <source>Window: bone</source>
        <translation>Fenster: Knochen</translation>
    </message>
    <message>
        <source>As scanned, or cleansed</source>
        <translation>Original oder digital gereinigt</translation>
    </message>
    <message>
        <source>cleansed</source>
        <translation>gereinigt</translation>
    </message>
    <message>
        <source>Linked: they follow the camera and one another</source>
        <translation>Gekoppelt: folgen der Kamera und einander</translation>
    </message>
    <message>
        <source>Thicker slab</source>
        <translation>Dickeres Schichtpaket</translation>
    </message>
    <message>
        <source>Thinner slab</source>
        <translation>Dünneres Schichtpaket</translation>
    </message>
    <message>
        <source>Slab: maximum instead of mean</source>
        <translation>Schichtpaket: Maximum statt Mittelwert</translation>
    </message>
    <message>
        <source>Measure a line: on a slice, or along the flattened wall</source>
        <translation>Strecke messen: in einer Schicht oder auf der abgewickelten Wand</translation>
    </message>
    <message>
        <source>Measure an ellipse on a slice, or an outline on the flattened wall</source>
        <translation>Ellipse in einer Schicht oder Umriss auf der abgewickelten Wand messen</translation>
    </message>
    <message>
        <source>Next look of the wall</source>
        <translation>Nächste Darstellung der Wand</translation>
    </message>
    <message>
        <source>Colours, opacities and light</source>
        <translation>Farben, Deckkraft und Licht</translation>
    </message>
    <message>
        <source>…</source>
        <translation>…</translation>
    </message>
    <message>
        <source>Fly over the flattened wall</source>
        <translation>Abgewickelte Wand überfliegen</translation>
    </message>
    <message>
        <source>Colour the wall around bookmarks</source>
        <translation>Wand um Lesezeichen einfärben</translation>
    </message>
    <message>
        <source>marks</source>
        <translation>Marken</translation>
    </message>
    <message>
        <source>Colour what has not been seen yet</source>
        <translation>Noch nicht Gesehenes einfärben</translation>
    </message>
    <message>
        <source>unseen</source>
        <translation>ungesehen</translation>
    </message>
    <message>
        <source>Nothing has been seen: begin anew</source>
        <translation>Alles wieder ungesehen: neu beginnen</translation>
    </message>
    <message>
        <source>Overview: with the body</source>
        <translation>Übersicht: mit Körper</translation>
    </message>
    <message>
        <source>Bookmark this place</source>
        <translation>Lesezeichen an dieser Stelle setzen</translation>
    </message>
    <message>
        <source>Bookmark with a note</source>
        <translation>Lesezeichen mit Notiz setzen</translation>
    </message>
    <message>
        <source>Previous bookmark</source>
        <translation>Voriges Lesezeichen</translation>
    </message>
    <message>
        <source>Next bookmark</source>
        <translation>Nächstes Lesezeichen</translation>
    </message>
    <message>
        <source>Show the list of bookmarks</source>
        <translation>Liste der Lesezeichen zeigen</translation>
    </message>
    <message>
        <source>Bookmarks</source>
        <translation>Lesezeichen</translation>
    </message>
    <message>
        <source>Keys and mouse</source>
        <translation>Tasten und Maus</translation>
    </message>
    <message>
        <source>Keys</source>
        <translation>Tasten</translation>
    </message>
    <message>
        <source>Change the keys…</source>
        <translation>Tasten ändern…</translation>
    </message>
    <message>
        <source>About Haustra and this server</source>
        <translation>Über Haustra und diesen Server</translation>
    </message>
    <message>
        <source>&amp;File</source>
        <translation>&amp;Datei</translation>
    </message>
    <message>
        <source>&amp;Edit</source>
        <translation>&amp;Bearbeiten</translation>
    </message>
    <message>
        <source>&amp;View</source>
        <translation>&amp;Ansicht</translation>
    </message>
    <message>
        <source>F&amp;light</source>
        <translation>&amp;Flug</translation>
    </message>
    <message>
        <source>&amp;Slices</source>
        <translation>&amp;Schichten</translation>
    </message>
    <message>
        <source>&amp;Wall</source>
        <translation>&amp;Wand</translation>
    </message>
    <message>
        <source>&amp;Bookmarks</source>
        <translation>&amp;Lesezeichen</translation>
    </message>
    <message>
        <source>&amp;Help</source>
        <translation>&amp;Hilfe</translation>
    </message>
    <message>
        <source>go to a bookmark</source>
        <translation>zu einem Lesezeichen gehen</translation>
    </message>
    <message>
        <source>Stop measuring, clear what was measured</source>
        <translation>Messen beenden, Gemessenes löschen</translation>
    </message>
    <message>
        <source>change the window</source>
        <translation>Fensterung ändern</translation>
    </message>
    <message>
        <source>This server cannot show slabs.</source>
        <translation>Dieser Server kann keine Schichtpakete zeigen.</translation>
    </message>
    <message>
        <source>change the slab</source>
        <translation>Schichtpaket ändern</translation>
    </message>
    <message>
        <source>Connect again</source>
        <translation>Neu verbinden</translation>
    </message>
    <message>
        <source>Next pane</source>
        <translation>Nächste Ansicht</translation>
    </message>
    <message>
        <source>Previous pane</source>
        <translation>Vorige Ansicht</translation>
    </message>
    <message>
        <source>Point with the keys: arrows move, Return clicks or draws</source>
        <translation>Mit den Tasten zeigen: Pfeile bewegen, Eingabe klickt oder zeichnet</translation>
    </message>
    <message>
        <source>Scroll on: the next slice, along the path</source>
        <translation>Weiterblättern: nächste Schicht, entlang dem Pfad</translation>
    </message>
    <message>
        <source>Scroll back</source>
        <translation>Zurückblättern</translation>
    </message>
    <message>
        <source>Scroll on, ten times as far</source>
        <translation>Zehnmal so weit weiterblättern</translation>
    </message>
    <message>
        <source>Scroll back, ten times as far</source>
        <translation>Zehnmal so weit zurückblättern</translation>
    </message>
    <message>
        <source>Enlarge the picture</source>
        <translation>Bild vergrößern</translation>
    </message>
    <message>
        <source>Make the picture smaller</source>
        <translation>Bild verkleinern</translation>
    </message>
    <message>
        <source>Look, turn, move or window: drag left</source>
        <translation>Blicken, drehen, verschieben oder fenstern: nach links ziehen</translation>
    </message>
    <message>
        <source>Look, turn, move or window: drag right</source>
        <translation>Blicken, drehen, verschieben oder fenstern: nach rechts ziehen</translation>
    </message>
    <message>
        <source>Look, turn, move or window: drag up</source>
        <translation>Blicken, drehen, verschieben oder fenstern: nach oben ziehen</translation>
    </message>
    <message>
        <source>Look, turn, move or window: drag down</source>
        <translation>Blicken, drehen, verschieben oder fenstern: nach unten ziehen</translation>
    </message>
    <message>
        <source>Move the slice&apos;s picture left</source>
        <translation>Schichtbild nach links schieben</translation>
    </message>
    <message>
        <source>Move the slice&apos;s picture right</source>
        <translation>Schichtbild nach rechts schieben</translation>
    </message>
    <message>
        <source>Move the slice&apos;s picture up</source>
        <translation>Schichtbild nach oben schieben</translation>
    </message>
    <message>
        <source>Move the slice&apos;s picture down</source>
        <translation>Schichtbild nach unten schieben</translation>
    </message>
    <message>
        <source>Free flight, off the path</source>
        <translation>Freier Flug, abseits des Pfads</translation>
    </message>
    <message>
        <source>Free flight: forward (held)</source>
        <translation>Freier Flug: vorwärts (gehalten)</translation>
    </message>
    <message>
        <source>Free flight: back (held)</source>
        <translation>Freier Flug: zurück (gehalten)</translation>
    </message>
    <message>
        <source>Free flight: left (held)</source>
        <translation>Freier Flug: nach links (gehalten)</translation>
    </message>
    <message>
        <source>Free flight: right (held)</source>
        <translation>Freier Flug: nach rechts (gehalten)</translation>
    </message>
    <message>
        <source>Free flight: up (held)</source>
        <translation>Freier Flug: nach oben (gehalten)</translation>
    </message>
    <message>
        <source>Free flight: down (held)</source>
        <translation>Freier Flug: nach unten (gehalten)</translation>
    </message>
    <message>
        <source>This case has no cleansed scan.</source>
        <translation>Für diesen Fall gibt es keine gereinigten CT-Daten.</translation>
    </message>
    <message>
        <source>&amp;Pane</source>
        <translation>B&amp;ildfeld</translation>
    </message>
    <message>
        <source>This server has no electronic biopsy.</source>
        <translation>Dieser Server hat keine elektronische Biopsie.</translation>
    </message>
    <message>
        <source>This server cannot show a lens.</source>
        <translation>Dieser Server kann keine Lupe zeigen.</translation>
    </message>
    <message>
        <source>Lens over the endoscopic view: electronic biopsy beneath the wall</source>
        <translation>Lupe über der endoskopischen Ansicht: elektronische Biopsie unter der Wand</translation>
    </message>
    <message>
        <source>lens</source>
        <translation>Lupe</translation>
    </message>
    <message>
        <source>Larger lens</source>
        <translation>Größere Lupe</translation>
    </message>
    <message>
        <source>Smaller lens</source>
        <translation>Kleinere Lupe</translation>
    </message>
    <message>
        <source>Measure between two places that are clicked, in whichever views</source>
        <translation>Zwischen zwei Orten messen, die angeklickt werden, in beliebigen Ansichten</translation>
    </message>
    <message>
        <source>Findings: not shown, after the first reading, at once</source>
        <translation>Befunde: nicht gezeigt, nach der eigenen Befundung, sofort</translation>
    </message>
    <message>
        <source>First reading done: show findings</source>
        <translation>Eigene Befundung beendet: Befunde zeigen</translation>
    </message>
    <message>
        <source>Previous finding</source>
        <translation>Voriger Befund</translation>
    </message>
    <message>
        <source>Next finding</source>
        <translation>Nächster Befund</translation>
    </message>
    <message>
        <source>Measure the finding</source>
        <translation>Den Befund messen</translation>
    </message>
    <message>
        <source>Show the list of findings</source>
        <translation>Die Liste der Befunde zeigen</translation>
    </message>
    <message>
        <source>Findings</source>
        <translation>Befunde</translation>
    </message>
    <message>
        <source>F&amp;indings</source>
        <translation>Bef&amp;unde</translation>
    </message>
    <message>
        <source>Previous missed patch of the wall</source>
        <translation>Vorige übersehene Stelle der Wand</translation>
    </message>
    <message>
        <source>Next missed patch of the wall</source>
        <translation>Nächste übersehene Stelle der Wand</translation>
    </message>
    <message>
        <source>Show what has been seen and missed</source>
        <translation>Zeigen, was gesehen und was übersehen wurde</translation>
    </message>
    <message>
        <source>Missed</source>
        <translation>Übersehen</translation>
    </message>
    <message>
        <source>Save a report of what has been seen…</source>
        <translation>Bericht über das Gesehene speichern …</translation>
    </message>
    <message>
        <source>first end of a ruler</source>
        <translation>erstes Ende eines Maßes</translation>
    </message>
</context>
<context>
    <name>Help</name>
    <message>
        <source>click in any view</source>
        <translation>Klick in eine beliebige Ansicht</translation>
    </message>
    <message>
        <source>go to that place, in all views</source>
        <translation>in allen Ansichten zu dieser Stelle gehen</translation>
    </message>
    <message>
        <source>drag the endoscopic view</source>
        <translation>Ziehen in der endoskopischen Ansicht</translation>
    </message>
    <message>
        <source>look around; double-click: straight ahead</source>
        <translation>umherblicken; Doppelklick: geradeaus</translation>
    </message>
    <message>
        <source>wheel on the endoscopic view</source>
        <translation>Mausrad in der endoskopischen Ansicht</translation>
    </message>
    <message>
        <source>move along the path; with Shift farther; with Ctrl the field of view</source>
        <translation>sich auf dem Pfad bewegen; mit Umschalt weiter; mit Strg das Blickfeld</translation>
    </message>
    <message>
        <source>drag a slice</source>
        <translation>Ziehen in einer Schicht</translation>
    </message>
    <message>
        <source>window (across) and centre (up, down)</source>
        <translation>Fensterbreite (quer) und Fenstermitte (auf, ab)</translation>
    </message>
    <message>
        <source>middle or right drag on a slice</source>
        <translation>Ziehen mit mittlerer oder rechter Taste in einer Schicht</translation>
    </message>
    <message>
        <source>move the picture</source>
        <translation>Bild verschieben</translation>
    </message>
    <message>
        <source>wheel on a slice</source>
        <translation>Mausrad in einer Schicht</translation>
    </message>
    <message>
        <source>scroll; with Ctrl enlarge; with Shift ten times as far</source>
        <translation>blättern; mit Strg vergrößern; mit Umschalt zehnmal so weit</translation>
    </message>
    <message>
        <source>Shift, Ctrl drag</source>
        <translation>Ziehen mit Umschalt, mit Strg</translation>
    </message>
    <message>
        <source>measure a line, an ellipse or an outline</source>
        <translation>Strecke, Ellipse oder Umriss messen</translation>
    </message>
    <message>
        <source>drag the overview</source>
        <translation>Ziehen in der Übersicht</translation>
    </message>
    <message>
        <source>turn it; wheel: enlarge; double-click: from the front</source>
        <translation>drehen; Mausrad: vergrößern; Doppelklick: von vorn</translation>
    </message>
    <message>
        <source>click a bookmark</source>
        <translation>Klick auf ein Lesezeichen</translation>
    </message>
    <message>
        <source>go there</source>
        <translation>dorthin gehen</translation>
    </message>
    <message>
        <source>drag the strip</source>
        <translation>Ziehen im abgewickelten Kolon</translation>
    </message>
    <message>
        <source>look it over</source>
        <translation>es durchmustern</translation>
    </message>
    <message>
        <source>drag the flattened wall</source>
        <translation>Ziehen auf der abgewickelten Wand</translation>
    </message>
    <message>
        <source>move it; wheel: enlarge</source>
        <translation>verschieben; Mausrad: vergrößern</translation>
    </message>
    <message>
        <source>press the track</source>
        <translation>Klick auf die Pfadleiste</translation>
    </message>
    <message>
        <source>go to that place along the path</source>
        <translation>zu dieser Stelle auf dem Pfad gehen</translation>
    </message>
    <message>
        <source>Alt drag in a view</source>
        <translation>Ziehen mit Alt in einer Ansicht</translation>
    </message>
    <message>
        <source>take its picture into another program</source>
        <translation>ihr Bild in ein anderes Programm ziehen</translation>
    </message>
    <message>
        <source>right click in a view</source>
        <translation>Rechtsklick in eine Ansicht</translation>
    </message>
    <message>
        <source>what else can be done there</source>
        <translation>was dort sonst noch möglich ist</translation>
    </message>
    <message>
        <source>Clear the field</source>
        <translation>Feld leeren</translation>
    </message>
    <message>
        <source>What does not fit</source>
        <translation>Was keinen Platz hat</translation>
    </message>
    <message>
        <source>Page Up, Page Down on a slice</source>
        <translation type="vanished">Bild auf, Bild ab auf einer Schicht</translation>
    </message>
    <message>
        <source>next, previous slice</source>
        <translation type="vanished">nächste, vorige Schicht</translation>
    </message>
    <message>
        <source>keys on the transfer function</source>
        <translation>Tasten auf der Übertragungsfunktion</translation>
    </message>
    <message>
        <source>N, P: next, previous point; arrows: move it; Insert, Delete: add, take it</source>
        <translation>N, P: nächster, voriger Punkt; Pfeile: verschieben; Einfg, Entf: hinzufügen, wegnehmen</translation>
    </message>
    <message>
        <source>arrows while the keys point</source>
        <translation>Pfeiltasten, während die Tasten zeigen</translation>
    </message>
    <message>
        <source>move the pointer; with Shift farther, with Ctrl by one pixel; Return clicks, or begins and ends a line or an outline</source>
        <translation>bewegen den Zeiger, mit Umschalt weiter, mit Strg um ein Pixel; Eingabe klickt oder beginnt und beendet eine Strecke oder einen Umriss</translation>
    </message>
    <message>
        <source>Alt wheel on the endoscopic view</source>
        <translation>Alt und Mausrad in der endoskopischen Ansicht</translation>
    </message>
    <message>
        <source>size of the lens, where it is on</source>
        <translation>Größe der Lupe, wenn sie an ist</translation>
    </message>
</context>
<context>
    <name>Language</name>
    <message>
        <source>As the system</source>
        <translation>Wie das System</translation>
    </message>
</context>
<context>
    <name>PictureOut</name>
    <message>
        <source>Save the picture</source>
        <translation>Bild speichern</translation>
    </message>
    <message>
        <source>Pictures (*.png)</source>
        <translation>Bilder (*.png)</translation>
    </message>
    <message>
        <source>cannot write %1: %2</source>
        <translation>%1 kann nicht geschrieben werden: %2</translation>
    </message>
</context>
<context>
    <name>ToldSentences</name>
    <message>
        <source>%1 mm2 of the wall were not examined: they enclose a bridge over a collapse, or were rebuilt after a leak</source>
        <translation>%1 mm² der Wand wurden nicht untersucht: Sie umgeben eine Brücke über einem Kollaps oder wurden nach einem Leck neu gebildet</translation>
    </message>
    <message>
        <source>%1 mm2 of the wall were not examined: they lie behind fluid without tagging or beside what stands in the lumen, where the wall&apos;s place is known to millimetres only</source>
        <translation>%1 mm² der Wand wurden nicht untersucht: Sie liegen hinter unmarkierter Flüssigkeit oder neben etwas, das im Lumen steht; dort ist die Lage der Wand nur auf einige Millimeter genau bekannt</translation>
    </message>
    <message>
        <source>the wall is %1 mm thick all around from %2 to %3 mm: it may be a cancer that leaves a channel, or a segment that is contracted</source>
        <translation>Die Wand ist von %2 bis %3 mm ringsum %1 mm dick: Es kann ein Karzinom sein, das einen Kanal frei lässt, oder ein kontrahierter Abschnitt</translation>
    </message>
    <message>
        <source>the wall is %1 mm thick all around from %2 to %3 mm: it may be a segment that is inflamed or contracted, or a long tumour</source>
        <translation>Die Wand ist von %2 bis %3 mm ringsum %1 mm dick: Es kann ein entzündeter oder kontrahierter Abschnitt sein oder ein langer Tumor</translation>
    </message>
    <message>
        <source>findings %1, from %2 mm on, lie rim to rim, %3 mm wide in all: they may be lobes of one mass</source>
        <translation>Die Befunde %1, ab %2 mm, liegen Rand an Rand, zusammen %3 mm breit: Es können Lappen einer einzigen Raumforderung sein</translation>
    </message>
    <message>
        <source>%1 place that looks like a polyp was taken for tagged residue on the wall: %2 mm from the rectum</source>
        <translation>%1 Ort, der wie ein Polyp aussieht, wurde für markierte Reste auf der Wand gehalten: %2 mm ab dem Rektum</translation>
    </message>
    <message>
        <source>%1 places that look like polyps were taken for tagged residue on the wall: %2 mm from the rectum</source>
        <translation>%1 Orte, die wie Polypen aussehen, wurden für markierte Reste auf der Wand gehalten: %2 mm ab dem Rektum</translation>
    </message>
    <message>
        <source>the tissue behind the wall is less even than where detection has learnt, %1 HU or more after smoothing to 1 mm: by noise, by contrast in its vessels, or by residue of weak tagging</source>
        <translation>Das Gewebe hinter der Wand ist ungleichmäßiger als dort, wo die Erkennung gelernt hat, %1 HU oder mehr nach Glättung auf 1 mm: durch Rauschen, Kontrastmittel in seinen Gefäßen oder schwach markierte Reste</translation>
    </message>
    <message>
        <source>more than %1 places may be polyps; the least probable are left out</source>
        <translation>Mehr als %1 Orte können Polypen sein; die unwahrscheinlichsten sind weggelassen</translation>
    </message>
    <message>
        <source>%1 places are told, more than a colon commonly has polyps: lumps of residue without tagging look alike, and most may be such</source>
        <translation>%1 Orte sind genannt, mehr, als ein Kolon gewöhnlich Polypen hat: Klumpen unmarkierter Reste sehen ebenso aus, und die meisten können solche sein</translation>
    </message>
    <message>
        <source>the colon was not flattened: the wall&apos;s texture was measured along other directions than detection has learnt from, and wall that is thick all around was not looked for</source>
        <translation>Das Kolon wurde nicht abgewickelt: Die Textur der Wand wurde in anderen Richtungen gemessen, als die Erkennung gelernt hat, und nach ringsum dicker Wand wurde nicht gesucht</translation>
    </message>
    <message>
        <source>the scan&apos;s kernel enhances edges, or the wall&apos;s surface is enhanced, as it is brighter behind gas than its tissue: detection has learnt from few like it, and may miss polyps of any size</source>
        <translation>Der Faltungskern der Aufnahme verstärkt Kanten, oder die Oberfläche der Wand nimmt Kontrastmittel auf, denn sie ist hinter Gas heller als ihr Gewebe: Die Erkennung hat aus wenigen solchen gelernt und kann Polypen jeder Größe übersehen</translation>
    </message>
    <message>
        <source>the scan&apos;s kernel enhances edges, or the wall&apos;s surface is enhanced, as it is brighter behind gas than its tissue: detection has learnt from few like it, and may miss polyps of any size, though it took off what it could</source>
        <translation>Der Faltungskern der Aufnahme verstärkt Kanten, oder die Oberfläche der Wand nimmt Kontrastmittel auf, denn sie ist hinter Gas heller als ihr Gewebe: Die Erkennung hat aus wenigen solchen gelernt und kann Polypen jeder Größe übersehen, obwohl sie abgezogen hat, was sie konnte</translation>
    </message>
    <message>
        <source>the scan&apos;s kernel enhances edges, or the wall&apos;s surface is enhanced, as it is brighter behind gas than its tissue: detection has learnt from few like it, and may miss polyps of any size, though what was added to edges was taken off before</source>
        <translation>Der Faltungskern der Aufnahme verstärkt Kanten, oder die Oberfläche der Wand nimmt Kontrastmittel auf, denn sie ist hinter Gas heller als ihr Gewebe: Die Erkennung hat aus wenigen solchen gelernt und kann Polypen jeder Größe übersehen, obwohl vorher abgezogen wurde, was den Kanten hinzugefügt war</translation>
    </message>
    <message>
        <source>the scan is more blurred than what detection has learnt from: polyps may be missed, and residue be told as polyps</source>
        <translation>Die Aufnahme ist unschärfer als das, woraus die Erkennung gelernt hat: Polypen können übersehen und Reste als Polypen genannt sein</translation>
    </message>
    <message>
        <source>the scan has samples up to %1 mm apart (CT colonography needs %2 at most): small and flat polyps may not show in it</source>
        <translation>Die Abtastpunkte der Aufnahme liegen bis zu %1 mm auseinander (CT-Kolonographie verlangt höchstens %2): Kleine und flache Polypen sind darin vielleicht nicht zu sehen</translation>
    </message>
    <message>
        <source>the scan has samples up to %1 mm apart (CT colonography needs %2 at most): polyps may not show in it, large ones among them</source>
        <translation>Die Abtastpunkte der Aufnahme liegen bis zu %1 mm auseinander (CT-Kolonographie verlangt höchstens %2): Polypen, auch große, sind darin vielleicht nicht zu sehen</translation>
    </message>
    <message>
        <source>the scan has slices %1 mm thick (%2 at most): small and flat polyps may not show in it</source>
        <translation>Die Schichten der Aufnahme sind %1 mm dick (höchstens %2): Kleine und flache Polypen sind darin vielleicht nicht zu sehen</translation>
    </message>
    <message>
        <source>the scan has slices %1 mm thick (%2 at most): polyps may not show in it, large ones among them</source>
        <translation>Die Schichten der Aufnahme sind %1 mm dick (höchstens %2): Polypen, auch große, sind darin vielleicht nicht zu sehen</translation>
    </message>
    <message>
        <source>the scan has samples up to %1 mm apart (CT colonography needs %2 at most) and slices %3 mm thick (%4 at most): small and flat polyps may not show in it</source>
        <translation>Die Abtastpunkte der Aufnahme liegen bis zu %1 mm auseinander (CT-Kolonographie verlangt höchstens %2), und ihre Schichten sind %3 mm dick (höchstens %4): Kleine und flache Polypen sind darin vielleicht nicht zu sehen</translation>
    </message>
    <message>
        <source>the scan has samples up to %1 mm apart (CT colonography needs %2 at most) and slices %3 mm thick (%4 at most): polyps may not show in it, large ones among them</source>
        <translation>Die Abtastpunkte der Aufnahme liegen bis zu %1 mm auseinander (CT-Kolonographie verlangt höchstens %2), und ihre Schichten sind %3 mm dick (höchstens %4): Polypen, auch große, sind darin vielleicht nicht zu sehen</translation>
    </message>
    <message>
        <source>the slices at %1 and %2 mm differ %3 times as much as those around: the patient breathed or moved between them, or slices do not belong there</source>
        <translation>Die Schichten bei %1 und %2 mm unterscheiden sich %3-mal so sehr wie die um sie her: Der Patient hat dazwischen geatmet oder sich bewegt, oder Schichten gehören nicht dorthin</translation>
    </message>
    <message>
        <source>the slices at %1 and %2 mm differ %3 times as much as those around, and %4 more pair by %5 times and more: the patient breathed or moved between them, or slices do not belong there</source>
        <translation>Die Schichten bei %1 und %2 mm unterscheiden sich %3-mal so sehr wie die um sie her, und %4 weiteres Paar %5-mal und mehr: Der Patient hat dazwischen geatmet oder sich bewegt, oder Schichten gehören nicht dorthin</translation>
    </message>
    <message>
        <source>the slices at %1 and %2 mm differ %3 times as much as those around, and %4 more pairs by %5 times and more: the patient breathed or moved between them, or slices do not belong there</source>
        <translation>Die Schichten bei %1 und %2 mm unterscheiden sich %3-mal so sehr wie die um sie her, und %4 weitere Paare %5-mal und mehr: Der Patient hat dazwischen geatmet oder sich bewegt, oder Schichten gehören nicht dorthin</translation>
    </message>
    <message>
        <source>%1 slice is the same as the one before, the first at %2 mm</source>
        <translation>%1 Schicht gleicht der vorigen, die erste bei %2 mm</translation>
    </message>
    <message>
        <source>%1 slices are the same as the one before, the first at %2 mm</source>
        <translation>%1 Schichten gleichen der vorigen, die erste bei %2 mm</translation>
    </message>
    <message>
        <source>the record of the scan&apos;s series is damaged, so that nobody knows how thick its slices are</source>
        <translation>Die Angaben zur Serie der Aufnahme sind beschädigt, sodass niemand weiß, wie dick ihre Schichten sind</translation>
    </message>
    <message>
        <source>the kernel is sharp: the wall beside gas is up to %1 HU bright, as tagged material is; thin residue on it is not seen, and detection may miss polyps, the more the sharper</source>
        <translation>Der Faltungskern ist scharf: Die Wand neben Gas ist bis zu %1 HU hell, wie markiertes Material; dünne Reste auf ihr sind nicht zu sehen, und die Erkennung kann Polypen übersehen, je schärfer, desto mehr</translation>
    </message>
    <message>
        <source>the air-fluid levels show that the patient lay %1, not %2 as the series says; the levels are believed</source>
        <translation>Die Flüssigkeitsspiegel zeigen, dass der Patient %1 lag, nicht %2, wie die Serie sagt; den Spiegeln wird geglaubt</translation>
    </message>
    <message>
        <source>patient position unknown, and no air-fluid level shows it: supine is assumed</source>
        <translation>Die Lage des Patienten ist unbekannt, und kein Flüssigkeitsspiegel zeigt sie: Rückenlage wird angenommen</translation>
    </message>
    <message>
        <source>%1 ml of air in the body are open to the room&apos;s, as through a stoma, and were taken for it: if they are bowel&apos;s, set up a wall (--cut X,Y,Z,R) between the skin and %2</source>
        <translation>%1 ml Luft im Körper stehen mit der des Raums in Verbindung, wie durch ein Stoma, und wurden für sie gehalten: Sind sie im Darm, so ist eine Wand zu setzen (--cut X,Y,Z,R) zwischen der Haut und %2</translation>
    </message>
    <message>
        <source>about %1 mm of the colon have no centerline, up to the %2 at %3</source>
        <translation>Etwa %1 mm des Kolons haben keine Mittellinie, bis hier: %2, bei %3</translation>
    </message>
    <message>
        <source>%1 % of the wall lies in blind pouches, which the strip shows as dots: the largest, of %2 mm², begins at %3 mm of the centerline. Look at it from within; the course may pass by a part of the colon</source>
        <translation>%1 % der Wand liegen in blinden Taschen, die der Streifen als Punkte zeigt: Die größte, von %2 mm², beginnt bei %3 mm der Mittellinie. Sie ist von innen anzusehen; der Verlauf kann an einem Teil des Kolons vorbeiführen</translation>
    </message>
    <message>
        <source>areas are not weighted, as the strip would fold, or has a large blind pouch: it is the conformal one</source>
        <translation>Flächen sind nicht gewichtet, da der Streifen sich falten würde oder eine große blinde Tasche hat: Er ist der konforme</translation>
    </message>
    <message>
        <source>no course of a colon was found in the mask; it is taken as it is</source>
        <translation>In der Maske wurde kein Verlauf eines Kolons gefunden; sie wird genommen, wie sie ist</translation>
    </message>
    <message>
        <source>%1 % of the mask are as bright as soft tissue in the scan: it may be another scan&apos;s, or hold stool or fluid without tagging</source>
        <translation>%1 % der Maske sind in der Aufnahme so hell wie Weichgewebe: Sie kann zu einer anderen Aufnahme gehören oder unmarkierten Stuhl oder unmarkierte Flüssigkeit enthalten</translation>
    </message>
    <message>
        <source>the scan ends within the %1, which it cuts open over %2 mm2; what lies beyond is not in it, at %3</source>
        <translation>Die Aufnahme endet im Kolon (%1) und schneidet es auf %2 mm² an; was jenseits liegt, fehlt in ihr, bei %3</translation>
    </message>
    <message>
        <source>the %1 is collapsed over %2 mm, or a mass closes it, at %3</source>
        <translation>%1: über %2 mm kollabiert oder von einer Raumforderung verschlossen, bei %3</translation>
    </message>
    <message>
        <source>the %1 is collapsed, or a mass closes it, at %2</source>
        <translation>%1: kollabiert oder von einer Raumforderung verschlossen, bei %2</translation>
    </message>
    <message>
        <source>what looks like a thin wall in the %1 was taken for open lumen, at %2</source>
        <translation>%1: Was wie eine dünne Wand aussieht, wurde für offenes Lumen gehalten, bei %2</translation>
    </message>
    <message>
        <source>the way on from the %1 is not sure (%2 %), at %3</source>
        <translation>%1: Wie es von hier weitergeht, ist nicht sicher (%2 %), bei %3</translation>
    </message>
    <message>
        <source>%1 ml at the wall of the %2 are as bright as metal, as of a stent, or thick barium: what lies there is not seen, at %3</source>
        <translation>%2: %1 ml an der Wand sind so hell wie Metall, etwa eines Stents, oder eingedicktes Barium; was dort liegt, ist nicht zu sehen, bei %3</translation>
    </message>
    <message>
        <source>%1 ml of %2 nearest to the %3 lie open to the colon and were taken for small bowel, at %4</source>
        <translation>%1 ml %2, am nächsten an: %3, sind zum Kolon offen und wurden für Dünndarm gehalten, bei %4</translation>
    </message>
    <message>
        <source>%1 ml of %2 nearest to the %3, as wide as colon and where it may lie, were taken for other than colon, at %4</source>
        <translation>%1 ml %2, am nächsten an: %3, so weit wie Kolon und dort, wo es liegen kann, wurden nicht für Kolon gehalten, bei %4</translation>
    </message>
    <message>
        <source>%1 ml of %2 nearest to the %3 were taken for other than colon, at %4</source>
        <translation>%1 ml %2, am nächsten an: %3, wurden nicht für Kolon gehalten, bei %4</translation>
    </message>
    <message>
        <source>%1 ml of gas away from the course were taken for the stomach&apos;s, other bowel&apos;s or free, at %2</source>
        <translation>%1 ml Gas abseits des Verlaufs wurden für Gas des Magens, anderer Darmabschnitte oder für freies Gas gehalten, bei %2</translation>
    </message>
    <message>
        <source>%1 ml in the %2 are as bright as tagged material, which shows no level in this scan; they may be bone, at %3</source>
        <translation>%2: %1 ml sind so hell wie markiertes Material, das in dieser Aufnahme nirgends einen Spiegel zeigt; es kann Knochen sein, bei %3</translation>
    </message>
    <message>
        <source>a wall of %1 mm2 between two loops was rebuilt, at %2</source>
        <translation>Eine Wand von %1 mm² zwischen zwei Schlingen wurde neu gebildet, bei %2</translation>
    </message>
    <message>
        <source>a wall of %1 mm2 was set up, beyond which gas and fluid were taken for other bowel; they may be the colon&apos;s, at %2</source>
        <translation>Eine Wand von %1 mm² wurde gesetzt, jenseits derer Gas und Flüssigkeit für anderen Darm gehalten wurden; sie können zum Kolon gehören, bei %2</translation>
    </message>
    <message>
        <source>%1 ml of fluid of little or no tagging were taken out of the %2; its wall shows little contrast and may lie elsewhere by millimetres</source>
        <translation>%2: %1 ml wenig oder gar nicht markierte Flüssigkeit wurden herausgenommen; die Wand zeigt wenig Kontrast und kann um Millimeter anderswo liegen</translation>
    </message>
    <message>
        <source>%1 ml of what was taken for tagged residue look like tissue once cleansed, and are no part of the lumen, at %2</source>
        <translation>%1 ml, die für markierte Reste gehalten wurden, sehen nach der Reinigung wie Gewebe aus und gehören nicht zum Lumen, bei %2</translation>
    </message>
    <message>
        <source>%1 ml of gas stand in the lumen of the %2 behind a wall of their own, as in a catheter&apos;s balloon; both were taken out, at %3</source>
        <translation>%2: %1 ml Gas stehen im Lumen hinter einer eigenen Wand, wie im Ballon eines Katheters; beides wurde herausgenommen, bei %3</translation>
    </message>
    <message>
        <source>%1 ml behind what looks like a thin wall, as of a catheter&apos;s balloon, were taken for the rectum&apos;s end, at %2</source>
        <translation>%1 ml hinter einer scheinbaren dünnen Wand, wie der eines Katheterballons, wurden für das Ende des Rektums gehalten, bei %2</translation>
    </message>
    <message>
        <source>%1 ml of gas lie below where the rectum begins: its end may be missing, as where a catheter&apos;s balloon fills it, at %2</source>
        <translation>%1 ml Gas liegen unterhalb des Beginns des Rektums: dessen Ende kann fehlen, etwa wenn der Ballon eines Katheters es ausfüllt, bei %2</translation>
    </message>
    <message>
        <source>fluid without tagging (%1 HU) stands under the gas in the %2, its surface %3 mm2; what lies in it and beneath is not seen, at %4</source>
        <translation>%2: Unmarkierte Flüssigkeit (%1 HU) steht unter dem Gas, ihre Oberfläche %3 mm²; was in ihr und darunter liegt, ist nicht zu sehen, bei %4</translation>
    </message>
    <message>
        <source>fluid of too little tagging (%1 HU) stands under the gas in the %2, its surface %3 mm2; what lies in it and beneath is not seen, at %4</source>
        <translation>%2: Zu schwach markierte Flüssigkeit (%1 HU) steht unter dem Gas, ihre Oberfläche %3 mm²; was in ihr und darunter liegt, ist nicht zu sehen, bei %4</translation>
    </message>
    <message>
        <source>the tagging is weak: what stands under the gas has %1 HU in the median, where 300 to 900 are best; residue may hide polyps, and be taken for them</source>
        <translation>Die Markierung ist schwach: Was unter dem Gas steht, hat im Median %1 HU, wo 300 bis 900 am besten sind; Reste können Polypen verdecken und für sie gehalten werden</translation>
    </message>
    <message>
        <source>another course is nearly as likely (%1 %): it adds %2 ml and drops %3 ml, at %4</source>
        <translation>Ein anderer Verlauf ist fast so wahrscheinlich (%1 %): Er nimmt %2 ml hinzu und lässt %3 ml weg, bei %4</translation>
    </message>
    <message>
        <source>the course is right with no more than %1 %; gravest: %2</source>
        <translation>Der Verlauf stimmt mit einer Wahrscheinlichkeit von höchstens %1 %; am schwersten wiegt: %2</translation>
    </message>
    <message>
        <source>the rectum was not found: the colon begins in the %1</source>
        <translation>Das Rektum wurde nicht gefunden: Das Kolon beginnt hier: %1</translation>
    </message>
    <message>
        <source>the cecum was not found: the colon ends in the %1</source>
        <translation>Das Zökum wurde nicht gefunden: Das Kolon endet hier: %1</translation>
    </message>
    <message>
        <source>%1 ml that nothing joins to the lumen were left out</source>
        <translation>%1 ml, die nichts mit dem Lumen verbindet, wurden weggelassen</translation>
    </message>
    <message>
        <source>two loops may only touch where %1 mm were crossed from the %2 on</source>
        <translation>%2: Wo %1 mm überbrückt wurden, berühren sich vielleicht nur zwei Schlingen</translation>
    </message>
    <message>
        <source>a loop may lie in the %1 mm that were crossed from the %2 on</source>
        <translation>%2: In den %1 mm, die überbrückt wurden, kann eine Schlinge liegen</translation>
    </message>
    <message>
        <source>what was taken for open in the %1 may be a wall</source>
        <translation>%1: Was für offen gehalten wurde, kann eine Wand sein</translation>
    </message>
    <message>
        <source>no more than %1 mm of %2 in all were found</source>
        <translation>%2: Nicht mehr als %1 mm wurden insgesamt gefunden</translation>
    </message>
    <message>
        <source>no more than %1 mm of %2 were found</source>
        <translation>%2: Nicht mehr als %1 mm wurden gefunden</translation>
    </message>
    <message>
        <source>the rectum was not found</source>
        <translation>Das Rektum wurde nicht gefunden</translation>
    </message>
    <message>
        <source>the cecum was not found</source>
        <translation>Das Zökum wurde nicht gefunden</translation>
    </message>
    <message>
        <source>the course may end before the cecum</source>
        <translation>Der Verlauf endet vielleicht vor dem Zökum</translation>
    </message>
    <message>
        <source>the %1 goes on beyond the edge of the scan</source>
        <translation>%1: Geht jenseits des Rands der Aufnahme weiter</translation>
    </message>
    <message>
        <source>%1 % of the mask lie in soft tissue</source>
        <translation>%1 % der Maske liegen in Weichgewebe</translation>
    </message>
    <message>
        <source>%1 ml of %2 as wide as colon, and where it may lie, were left out near the %3</source>
        <translation>%3: %1 ml %2, so weit wie Kolon und dort, wo es liegen kann, wurden in der Nähe weggelassen</translation>
    </message>
    <message>
        <source>%1 ml of gas near the %2 may be colon</source>
        <translation>%2: %1 ml Gas in der Nähe können Kolon sein</translation>
    </message>
    <message>
        <source>%1 ml of fluid that lie open to the %2 may be colon</source>
        <translation>%2: %1 ml Flüssigkeit, die dorthin offen sind, können Kolon sein</translation>
    </message>
    <message>
        <source>a wall of %1 mm2 that was set up is wider than bowel that touches</source>
        <translation>Eine gesetzte Wand von %1 mm² ist breiter als Darm, der sich berührt</translation>
    </message>
    <message>
        <source>a rebuilt wall of %1 mm2 may be none</source>
        <translation>Eine neu gebildete Wand von %1 mm² ist vielleicht keine</translation>
    </message>
    <message>
        <source>%1 ml of untagged fluid may be other than lumen</source>
        <translation>%1 ml unmarkierte Flüssigkeit gehören vielleicht nicht zum Lumen</translation>
    </message>
    <message>
        <source>untagged fluid in the %1 may hide lumen</source>
        <translation>%1: Unmarkierte Flüssigkeit kann Lumen verbergen</translation>
    </message>
    <message>
        <source>%1 small and %2 full-size phantoms made by haustra phantom, and calibrated on %3 small and %4 full-size others, no patient: how probable a place is to be a polyp holds for phantoms, and is no more than an ordering for patients</source>
        <translation>%1 kleinen Phantomen und %2 in voller Größe, von „haustra phantom“ gemacht, kalibriert an %3 kleinen anderen und %4 in voller Größe, keinem Patienten: Wie wahrscheinlich ein Ort ein Polyp ist, gilt für Phantome; für Patienten ist es nur eine Reihenfolge</translation>
    </message>
    <message>
        <source>rectum</source>
        <translation>Rektum</translation>
    </message>
    <message>
        <source>sigmoid</source>
        <translation>Sigma</translation>
    </message>
    <message>
        <source>descending colon</source>
        <translation>Colon descendens</translation>
    </message>
    <message>
        <source>splenic flexure</source>
        <translation>linke Flexur</translation>
    </message>
    <message>
        <source>transverse colon</source>
        <translation>Colon transversum</translation>
    </message>
    <message>
        <source>hepatic flexure</source>
        <translation>rechte Flexur</translation>
    </message>
    <message>
        <source>ascending colon</source>
        <translation>Colon ascendens</translation>
    </message>
    <message>
        <source>cecum</source>
        <translation>Zökum</translation>
    </message>
    <message>
        <source>fluid without tagging</source>
        <translation>unmarkierte Flüssigkeit</translation>
    </message>
    <message>
        <source>tagged material</source>
        <translation>markiertes Material</translation>
    </message>
    <message>
        <source>gas</source>
        <translation>Gas</translation>
    </message>
    <message>
        <source>fluid</source>
        <translation>Flüssigkeit</translation>
    </message>
    <message>
        <source>supine</source>
        <translation>auf dem Rücken</translation>
    </message>
    <message>
        <source>prone</source>
        <translation>auf dem Bauch</translation>
    </message>
    <message>
        <source>on the left side</source>
        <translation>auf der linken Seite</translation>
    </message>
    <message>
        <source>on the right side</source>
        <translation>auf der rechten Seite</translation>
    </message>
    <message>
        <source>left-decubitus</source>
        <translation>auf der linken Seite</translation>
    </message>
    <message>
        <source>right-decubitus</source>
        <translation>auf der rechten Seite</translation>
    </message>
    <message>
        <source> and </source>
        <comment>between the last two</comment>
        <translation> und </translation>
    </message>
    <message>
        <source> and elsewhere</source>
        <translation> und anderswo</translation>
    </message>
    <message>
        <source>%1 ml are brighter than bone, as metal and thick barium are: at the height of their streaks walls and fluid may be wrong or missing, at %2</source>
        <translation>%1 ml sind heller als Knochen, wie Metall und eingedicktes Barium: Auf der Höhe ihrer Streifen können Wände und Flüssigkeit falsch sein oder fehlen, bei %2</translation>
    </message>
    <message>
        <source>calibrated on %1 other case</source>
        <translation>kalibriert an %1 anderen Fall</translation>
    </message>
    <message>
        <source>calibrated on %1 other cases</source>
        <translation>kalibriert an %1 anderen Fällen</translation>
    </message>
    <message>
        <source>cases that somebody chose</source>
        <translation>Fällen, die jemand ausgewählt hat</translation>
    </message>
    <message>
        <source>on %1 mm of the colon, from %2 mm on, nothing is told of how thick the wall is: %3 HU at most behind it are fluid&apos;s, around the colon or in a wall that is swollen</source>
        <translation>Auf %1 mm des Kolons, ab %2 mm, wird nicht gesagt, wie dick die Wand ist: Höchstens %3 HU dahinter gehören zu Flüssigkeit, um das Kolon oder in einer geschwollenen Wand</translation>
    </message>
    <message>
        <source>the wall, or what lies between it and other loops, is thick all around at %1 mm: other bowel may lie on it without fat between, or a cancer narrow it</source>
        <translation>Die Wand, oder was zwischen ihr und anderen Schlingen liegt, ist bei %1 mm ringsum dick: Anderer Darm kann ohne Fett dazwischen anliegen, oder ein Karzinom engt sie ein</translation>
    </message>
    <message>
        <source>polyps may be missed: %1</source>
        <translation>Polypen können übersehen sein: %1</translation>
    </message>
    <message>
        <source>an opening of %1 mm2 was kept, as without it the colon is parted: a polyp or a fold may stand in the way, or two loops touch, at %2</source>
        <translation>Eine Öffnung von %1 mm² blieb, da das Kolon ohne sie geteilt ist: Ein Polyp oder eine Falte kann im Weg stehen, oder zwei Schlingen berühren sich, bei %2</translation>
    </message>
    <message>
        <source>%1 ml of the colon are joined to nothing, and were left out</source>
        <translation>%1 ml des Kolons hängen mit nichts zusammen und wurden ausgelassen</translation>
    </message>
    <message>
        <source>the wall is %1 mm thick all around from %2 to %3 mm, but the lumen is %4 mm wide: other bowel may lie around it, or it is inflamed</source>
        <translation>Die Wand ist von %2 bis %3 mm ringsum %1 mm dick, aber das Lumen ist %4 mm weit: Anderer Darm kann ringsum anliegen, oder sie ist entzündet</translation>
    </message>
</context>
<context>
    <name>haustra::window::BookmarkPanel</name>
    <message>
        <source>B marks the place in view; Shift+B with a note.</source>
        <translation>B setzt ein Lesezeichen an der gezeigten Stelle, Umschalt+B eines mit Notiz.</translation>
    </message>
    <message>
        <source>note, then Enter</source>
        <translation>Notiz, dann Enter</translation>
    </message>
    <message>
        <source>Note of a new bookmark</source>
        <translation>Notiz für ein neues Lesezeichen</translation>
    </message>
    <message>
        <source>Bookmark this place with this note</source>
        <translation>Lesezeichen mit dieser Notiz an dieser Stelle setzen</translation>
    </message>
    <message>
        <source>Add the bookmark</source>
        <translation>Lesezeichen hinzufügen</translation>
    </message>
    <message>
        <source>Bookmarks along the colon</source>
        <translation>Lesezeichen entlang des Kolons</translation>
    </message>
    <message>
        <source>mm</source>
        <translation>mm</translation>
    </message>
    <message>
        <source>Note</source>
        <translation>Notiz</translation>
    </message>
    <message>
        <source>Saved</source>
        <translation>Gespeichert</translation>
    </message>
    <message>
        <source>sending…</source>
        <translation>wird gesendet…</translation>
    </message>
    <message>
        <source>refused</source>
        <translation>abgelehnt</translation>
    </message>
    <message>
        <source>Bookmark</source>
        <translation>Lesezeichen</translation>
    </message>
    <message>
        <source>go to a bookmark</source>
        <translation>zu einem Lesezeichen gehen</translation>
    </message>
    <message>
        <source>Go there</source>
        <translation>Dorthin gehen</translation>
    </message>
    <message>
        <source>Send again…</source>
        <translation>Erneut senden…</translation>
    </message>
    <message>
        <source>Send the bookmark again</source>
        <translation>Lesezeichen erneut senden</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>Verwerfen</translation>
    </message>
    <message>
        <source>That bookmark is no longer to be sent.</source>
        <translation>Dieses Lesezeichen ist nicht mehr zu senden.</translation>
    </message>
    <message>
        <source>At %1 mm, not saved: %2. Enter sends it again.</source>
        <translation>Bei %1 mm, nicht gespeichert: %2. Eingabe sendet es noch einmal.</translation>
    </message>
</context>
<context>
    <name>haustra::window::CaseList</name>
    <message>
        <source>damaged</source>
        <translation>beschädigt</translation>
    </message>
    <message>
        <source>ready</source>
        <translation>bereit</translation>
    </message>
    <message>
        <source>cleansed</source>
        <translation>gereinigt</translation>
    </message>
    <message>
        <source>flattened</source>
        <translation>abgewickelt</translation>
    </message>
    <message>
        <source>%1 % sure</source>
        <translation>%1 % sicher</translation>
    </message>
    <message numerus="yes">
        <source>%n place(s) to look at</source>
        <translation>
            <numerusform>%n Stelle zu prüfen</numerusform>
            <numerusform>%n Stellen zu prüfen</numerusform>
        </translation>
    </message>
    <message>
        <source>Open</source>
        <translation>Öffnen</translation>
    </message>
    <message>
        <source>search</source>
        <translation>suchen</translation>
    </message>
    <message>
        <source>Search in the list of cases</source>
        <translation>In der Liste der Fälle suchen</translation>
    </message>
    <message>
        <source>Cases of the server</source>
        <translation>Fälle auf dem Server</translation>
    </message>
    <message>
        <source>Connecting…</source>
        <translation>Verbindung wird aufgebaut…</translation>
    </message>
    <message>
        <source>Opening the case…</source>
        <translation>Fall wird geöffnet…</translation>
    </message>
    <message>
        <source>Waiting for the server…</source>
        <translation>Warten auf den Server…</translation>
    </message>
    <message>
        <source>No connection</source>
        <translation>Keine Verbindung</translation>
    </message>
    <message>
        <source>The server has no case yet</source>
        <translation>Der Server hat noch keinen Fall</translation>
    </message>
    <message>
        <source>Choose a case</source>
        <translation>Fall auswählen</translation>
    </message>
    <message numerus="yes">
        <source>%n case(s) on %1</source>
        <translation>
            <numerusform>%n Fall auf %1</numerusform>
            <numerusform>%n Fälle auf %1</numerusform>
        </translation>
    </message>
    <message>
        <source>Case</source>
        <translation>Fall</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Status</translation>
    </message>
    <message>
        <source>Colon</source>
        <translation>Kolon</translation>
    </message>
    <message>
        <source>Slices</source>
        <translation>Schichten</translation>
    </message>
    <message>
        <source>Bookmarks</source>
        <translation>Lesezeichen</translation>
    </message>
    <message>
        <source>Open for</source>
        <translation>Geöffnet bei</translation>
    </message>
    <message>
        <source>Prepared</source>
        <translation>Aufbereitet</translation>
    </message>
    <message numerus="yes">
        <source>%n reader(s)</source>
        <translation>
            <numerusform>%n Person</numerusform>
            <numerusform>%n Personen</numerusform>
        </translation>
    </message>
    <message>
        <source>not ready</source>
        <translation>nicht bereit</translation>
    </message>
    <message>
        <source>Back to the list of cases</source>
        <translation>Zurück zur Liste der Fälle</translation>
    </message>
    <message>
        <source>Connect again</source>
        <translation>Neu verbinden</translation>
    </message>
    <message>
        <source>“%1” is opened when it is back.</source>
        <translation>„%1“ wird geöffnet, wenn er wieder da ist.</translation>
    </message>
</context>
<context>
    <name>haustra::window::EndoscopicPane</name>
    <message>
        <source>Endoscopic view</source>
        <translation>Endoskopische Ansicht</translation>
    </message>
    <message>
        <source>free flight</source>
        <translation>freier Flug</translation>
    </message>
    <message>
        <source>%1 mm of %2 mm, %3</source>
        <translation>%1 mm von %2 mm, %3</translation>
    </message>
    <message>
        <source>towards the cecum</source>
        <translation>Richtung Zökum</translation>
    </message>
    <message>
        <source>towards the rectum</source>
        <translation>Richtung Rektum</translation>
    </message>
    <message>
        <source>Straight ahead</source>
        <translation>Geradeaus</translation>
    </message>
    <message>
        <source>Free flight</source>
        <translation>Freier Flug</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>W A S D move, drag to look, C returns to the path</source>
        <translation>W A S D bewegen, Ziehen zum Umherblicken, C zurück zum Pfad</translation>
    </message>
    <message>
        <source>of %1 mm, %2</source>
        <translation>von %1 mm, %2</translation>
    </message>
    <message>
        <source>bridge of %1 mm: the colon is collapsed or filled, no wall is seen</source>
        <translation>Brücke von %1 mm: Kolon kollabiert oder gefüllt, keine Wand zu sehen</translation>
    </message>
    <message>
        <source>look %1°  %2°   double-click: straight ahead</source>
        <translation>Blick %1°  %2°   Doppelklick: geradeaus</translation>
    </message>
    <message>
        <source>old</source>
        <translation>veraltet</translation>
    </message>
    <message>
        <source>exact</source>
        <translation>exakt</translation>
    </message>
    <message>
        <source>moving</source>
        <translation>bewegt</translation>
    </message>
    <message>
        <source>This server cannot tell where the wall is that was clicked.</source>
        <translation>Dieser Server kann die angeklickte Stelle der Wand nicht bestimmen.</translation>
    </message>
    <message>
        <source>go to a place of the wall</source>
        <translation>zu einer Stelle der Wand gehen</translation>
    </message>
    <message>
        <source>this server cannot show a lens</source>
        <translation>dieser Server kann keine Lupe zeigen</translation>
    </message>
    <message>
        <source>electronic biopsy, colours of this scan</source>
        <translation>elektronische Biopsie, Farben aus dieser Aufnahme</translation>
    </message>
    <message>
        <source>electronic biopsy, fixed colours</source>
        <translation>elektronische Biopsie, feste Farben</translation>
    </message>
    <message>
        <source>less dense</source>
        <translation>weniger dicht</translation>
    </message>
    <message>
        <source>denser</source>
        <translation>dichter</translation>
    </message>
</context>
<context>
    <name>haustra::window::FindingsPanel</name>
    <message>
        <source>rectum</source>
        <translation>Rektum</translation>
    </message>
    <message>
        <source>sigmoid</source>
        <translation>Sigma</translation>
    </message>
    <message>
        <source>descending</source>
        <translation>Descendens</translation>
    </message>
    <message>
        <source>transverse</source>
        <translation>Transversum</translation>
    </message>
    <message>
        <source>ascending</source>
        <translation>Ascendens</translation>
    </message>
    <message>
        <source>cecum</source>
        <translation>Zökum</translation>
    </message>
    <message>
        <source>%1 %</source>
        <translation>%1 %</translation>
    </message>
    <message>
        <source>go to a finding</source>
        <translation>zu einem Befund gehen</translation>
    </message>
    <message>
        <source>After my own reading (second reader)</source>
        <translation>Nach der eigenen Befundung (Zweitbefunder)</translation>
    </message>
    <message>
        <source>From the start (concurrent)</source>
        <translation>Von Anfang an (gleichzeitig)</translation>
    </message>
    <message>
        <source>Not shown</source>
        <translation>Nicht gezeigt</translation>
    </message>
    <message>
        <source>Findings: %1</source>
        <translation>Befunde: %1</translation>
    </message>
    <message>
        <source>Findings are not shown in this mode.</source>
        <translation>In diesem Modus werden Befunde nicht gezeigt.</translation>
    </message>
    <message>
        <source>No finding further along the colon.</source>
        <translation>Weiter im Kolon ist kein Befund.</translation>
    </message>
    <message>
        <source>No finding before this place.</source>
        <translation>Vor diesem Ort ist kein Befund.</translation>
    </message>
    <message>
        <source>Go to a finding first.</source>
        <translation>Zuerst zu einem Befund gehen.</translation>
    </message>
    <message>
        <source>also those from</source>
        <translation>auch solche ab</translation>
    </message>
    <message>
        <source>When findings are shown</source>
        <translation>Wann Befunde gezeigt werden</translation>
    </message>
    <message>
        <source>Places that scored below the operating point, in another colour</source>
        <translation>Orte unter dem Arbeitspunkt, in anderer Farbe</translation>
    </message>
    <message>
        <source> %</source>
        <translation> %</translation>
    </message>
    <message>
        <source>Also show less probable findings</source>
        <translation>Auch weniger wahrscheinliche Befunde zeigen</translation>
    </message>
    <message>
        <source>Least probability of less probable findings</source>
        <translation>Kleinste Wahrscheinlichkeit weniger wahrscheinlicher Befunde</translation>
    </message>
    <message>
        <source>Findings along the colon</source>
        <translation>Befunde entlang des Kolons</translation>
    </message>
    <message>
        <source>No.</source>
        <translation>Nr.</translation>
    </message>
    <message>
        <source>mm</source>
        <translation>mm</translation>
    </message>
    <message>
        <source>Segment</source>
        <translation>Segment</translation>
    </message>
    <message>
        <source>Size</source>
        <translation>Größe</translation>
    </message>
    <message>
        <source>Prob.</source>
        <translation>Wahrsch.</translation>
    </message>
    <message>
        <source>From the rectum</source>
        <translation>Vom Rektum an</translation>
    </message>
    <message>
        <source>Probability</source>
        <translation>Wahrscheinlichkeit</translation>
    </message>
    <message>
        <source>What must be known of the findings</source>
        <translation>Was man von den Befunden wissen muss</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>%1, %2 mm high</source>
        <translation>%1, %2 mm hoch</translation>
    </message>
    <message>
        <source>The findings of this case cannot be read.</source>
        <translation>Die Befunde dieses Falls sind nicht lesbar.</translation>
    </message>
    <message>
        <source>Findings are not shown.</source>
        <translation>Befunde werden nicht gezeigt.</translation>
    </message>
    <message>
        <source>Findings are shown once the first reading is done.</source>
        <translation>Befunde werden gezeigt, sobald die eigene Befundung beendet ist.</translation>
    </message>
    <message>
        <source>asking…</source>
        <translation>wird gefragt …</translation>
    </message>
    <message numerus="yes">
        <source>%n place(s) to judge</source>
        <translation>
            <numerusform>%n Ort zu beurteilen</numerusform>
            <numerusform>%n Orte zu beurteilen</numerusform>
        </translation>
    </message>
    <message>
        <source>For a physician to judge.</source>
        <translation>Vom Arzt zu beurteilen.</translation>
    </message>
    <message>
        <source>Found by %1, which has learnt from: %2. Operating point %3.</source>
        <translation>Gefunden von %1, das gelernt hat aus: %2. Arbeitspunkt %3.</translation>
    </message>
    <message>
        <source>This server cannot show findings.</source>
        <translation>Dieser Server kann keine Befunde zeigen.</translation>
    </message>
    <message>
        <source>This case has not been searched for polyps.</source>
        <translation>In diesem Fall wurde nicht nach Polypen gesucht.</translation>
    </message>
    <message>
        <source>No findings wait for the first reading in this mode.</source>
        <translation>In diesem Modus warten keine Befunde auf die eigene Befundung.</translation>
    </message>
    <message>
        <source>Measure</source>
        <translation>Messen</translation>
    </message>
    <message>
        <source>The finding&apos;s largest diameter, as a ruler in all views</source>
        <translation>Der größte Durchmesser des Befunds, als Maß in allen Ansichten</translation>
    </message>
    <message>
        <source>sessile</source>
        <translation>sessil</translation>
    </message>
    <message>
        <source>pedunculated</source>
        <translation>gestielt</translation>
    </message>
    <message>
        <source>flat</source>
        <translation>flach</translation>
    </message>
    <message>
        <source>The first reading is not done</source>
        <translation>Die eigene Befundung ist nicht beendet</translation>
    </message>
    <message>
        <source>Show the findings all the same, in this and the next cases?</source>
        <translation>Die Befunde trotzdem zeigen, in diesem und den nächsten Fällen?</translation>
    </message>
    <message>
        <source>all around, %1 mm thick</source>
        <translation>ringsum, %1 mm dick</translation>
    </message>
    <message>
        <source>A rule tells it: no probability</source>
        <translation>Eine Regel nennt ihn: keine Wahrscheinlichkeit</translation>
    </message>
    <message>
        <source>First reading done:
show findings</source>
        <translation>Eigene Befundung beendet:
Befunde zeigen</translation>
    </message>
</context>
<context>
    <name>haustra::window::FlatZoomPane</name>
    <message>
        <source>Flattened wall</source>
        <translation>Abgewickelte Wand</translation>
    </message>
    <message>
        <source>Whole circumference</source>
        <translation>Gesamter Umfang</translation>
    </message>
    <message>
        <source>Clear the measurement</source>
        <translation>Messung löschen</translation>
    </message>
    <message>
        <source>%1 mm across   %2 mm²</source>
        <translation>max. Ø %1 mm   %2 mm²</translation>
    </message>
    <message>
        <source>%1 mm   straight %2 mm</source>
        <translation>%1 mm   geradlinig %2 mm</translation>
    </message>
    <message>
        <source>Fly-over   %1 mm</source>
        <translation>Überflug   %1 mm</translation>
    </message>
    <message>
        <source>cecum ↑</source>
        <translation>Zökum ↑</translation>
    </message>
    <message>
        <source>×%1   cecum ↑</source>
        <translation>×%1   Zökum ↑</translation>
    </message>
    <message>
        <source>drag a line to measure it   Esc ends</source>
        <translation>Strecke zum Messen ziehen   Esc beendet</translation>
    </message>
    <message>
        <source>drag around a polyp   Esc ends</source>
        <translation>Polypen umfahren   Esc beendet</translation>
    </message>
    <message>
        <source>go to a place of the wall</source>
        <translation>zu einer Stelle der Wand gehen</translation>
    </message>
    <message>
        <source>measure on the wall</source>
        <translation>auf der Wand messen</translation>
    </message>
    <message>
        <source>click two places to measure between them   Esc ends</source>
        <translation>zwei Orte anklicken, um dazwischen zu messen   Esc beendet</translation>
    </message>
    <message>
        <source>clear the measurement</source>
        <translation>Messung löschen</translation>
    </message>
</context>
<context>
    <name>haustra::window::FlightBar</name>
    <message>
        <source>Speed of flight</source>
        <translation>Fluggeschwindigkeit</translation>
    </message>
    <message>
        <source>Speed (+ and −)</source>
        <translation>Geschwindigkeit (+ und −)</translation>
    </message>
    <message>
        <source>%1 mm/s</source>
        <translation>%1 mm/s</translation>
    </message>
    <message>
        <source>Field of view, degrees</source>
        <translation>Blickfeld, Grad</translation>
    </message>
    <message>
        <source>Field of view (Ctrl and the wheel on the endoscopic view)</source>
        <translation>Blickfeld (Strg und Mausrad in der endoskopischen Ansicht)</translation>
    </message>
    <message>
        <source>Look of the wall</source>
        <translation>Darstellung der Wand</translation>
    </message>
    <message>
        <source>Window of the slices</source>
        <translation>Fensterung der Schichten</translation>
    </message>
    <message>
        <source>own</source>
        <translation>eigenes</translation>
    </message>
    <message>
        <source>Wall</source>
        <translation>Wand</translation>
    </message>
    <message>
        <source>Slices</source>
        <translation>Schichten</translation>
    </message>
    <message>
        <source>colon</source>
        <translation>Kolon</translation>
    </message>
    <message>
        <source>soft tissue</source>
        <translation>Weichteile</translation>
    </message>
    <message>
        <source>lung</source>
        <translation>Lunge</translation>
    </message>
    <message>
        <source>bone</source>
        <translation>Knochen</translation>
    </message>
    <message>
        <source>Flight</source>
        <translation>Flug</translation>
    </message>
    <message>
        <source>choose a preset</source>
        <translation>Vorlage wählen</translation>
    </message>
</context>
<context>
    <name>haustra::window::GreyPane</name>
    <message>
        <source>cleansed</source>
        <translation>gereinigt</translation>
    </message>
    <message>
        <source>maximum of %1 mm</source>
        <translation>Maximum über %1 mm</translation>
    </message>
    <message>
        <source>mean of %1 mm</source>
        <translation>Mittelwert über %1 mm</translation>
    </message>
    <message>
        <source>window centre %1, width %2 HU</source>
        <translation>Fenstermitte %1, Fensterbreite %2 HU</translation>
    </message>
    <message>
        <source>Clear rulers and ellipses</source>
        <translation>Strecken und Ellipsen löschen</translation>
    </message>
    <message>
        <source>draw an ellipse</source>
        <translation>Ellipse zeichnen</translation>
    </message>
    <message>
        <source>draw a ruler</source>
        <translation>Strecke zeichnen</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>%1 mm²</source>
        <translation>%1 mm²</translation>
    </message>
    <message>
        <source>mean %1 ± %2 HU   %3</source>
        <translation>Mittelwert %1 ± %2 HU   %3</translation>
    </message>
    <message>
        <source>C %1  W %2 HU</source>
        <translation>C %1  W %2 HU</translation>
    </message>
    <message>
        <source>%1 HU</source>
        <translation>%1 HU</translation>
    </message>
</context>
<context>
    <name>haustra::window::HelpPage</name>
    <message>
        <source>Keys and mouse</source>
        <translation>Tasten und Maus</translation>
    </message>
    <message>
        <source>Key</source>
        <translation>Taste</translation>
    </message>
    <message>
        <source>Meaning</source>
        <translation>Bedeutung</translation>
    </message>
    <message>
        <source>Mouse</source>
        <translation>Maus</translation>
    </message>
    <message>
        <source>For a physician&apos;s judgement; not a certified medical device.</source>
        <translation>Zur ärztlichen Beurteilung; kein zertifiziertes Medizinprodukt.</translation>
    </message>
    <message>
        <source>Virtual colonoscopy. For a physician&apos;s judgement; not a certified medical device.</source>
        <translation>Virtuelle Koloskopie (CT-Kolonographie). Zur ärztlichen Beurteilung; kein zertifiziertes Medizinprodukt.</translation>
    </message>
    <message>
        <source>Server</source>
        <translation>Server</translation>
    </message>
    <message>
        <source>Software</source>
        <translation>Software</translation>
    </message>
    <message>
        <source>Renderer</source>
        <translation>Renderer</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>Zertifikat</translation>
    </message>
    <message>
        <source>About Haustra</source>
        <translation>Über Haustra</translation>
    </message>
</context>
<context>
    <name>haustra::window::KeysDialog</name>
    <message>
        <source>Command</source>
        <translation>Befehl</translation>
    </message>
    <message>
        <source>Keys</source>
        <translation>Tasten</translation>
    </message>
    <message>
        <source>Change the keys</source>
        <translation>Tasten ändern</translation>
    </message>
    <message>
        <source>Commands and their keys</source>
        <translation>Befehle und ihre Tasten</translation>
    </message>
    <message>
        <source>Change…</source>
        <translation>Ändern…</translation>
    </message>
    <message>
        <source>All as they were at first</source>
        <translation>Alle zurücksetzen</translation>
    </message>
    <message>
        <source>The new key</source>
        <translation>Neue Taste</translation>
    </message>
    <message>
        <source>No key</source>
        <translation>Keine Taste</translation>
    </message>
    <message>
        <source>The key is taken</source>
        <translation>Die Taste ist belegt</translation>
    </message>
    <message>
        <source>%1 is the key of “%2”. Take it from there?</source>
        <translation>%1 ist schon die Taste für „%2“. Dort entfernen?</translation>
    </message>
    <message>
        <source>Press the new key for “%1”. It takes the place of: %2. An empty field means: no key.</source>
        <translation type="vanished">Neue Taste für „%1“ drücken. Sie ersetzt: %2. Ein leeres Feld bedeutet: keine Taste.</translation>
    </message>
    <message>
        <source>Press the new key for “%1”. An empty field means: no key.</source>
        <translation>Die neue Taste für „%1“ drücken. Ein leeres Feld bedeutet: keine Taste.</translation>
    </message>
    <message>
        <source>keep the keys that it has: %1</source>
        <translation>die bisherigen Tasten behalten: %1</translation>
    </message>
    <message>
        <source>This is a key to be held: one key, without Shift, Ctrl or Alt.</source>
        <translation>Diese Taste wird gehalten: eine Taste, ohne Umschalt, Strg oder Alt.</translation>
    </message>
</context>
<context>
    <name>haustra::window::MissedPanel</name>
    <message>
        <source>This case has not been flattened.</source>
        <translation>Für diesen Fall gibt es keine Abwicklung.</translation>
    </message>
    <message>
        <source>This server does not keep what has been seen.</source>
        <translation>Dieser Server führt nicht Buch über das Gesehene.</translation>
    </message>
    <message>
        <source>go to a missed patch</source>
        <translation>zu einer übersehenen Stelle gehen</translation>
    </message>
    <message>
        <source>Previous</source>
        <translation>Vorige</translation>
    </message>
    <message>
        <source>Next</source>
        <translation>Nächste</translation>
    </message>
    <message>
        <source>Save a report…</source>
        <translation>Bericht speichern …</translation>
    </message>
    <message>
        <source>Share of the wall that has been seen</source>
        <translation>Anteil der Wand, der gesehen wurde</translation>
    </message>
    <message>
        <source>What every reader has seen of this wall, and missed, as a JSON file</source>
        <translation>Was jeder Befunder von dieser Wand gesehen und übersehen hat, als JSON-Datei</translation>
    </message>
    <message>
        <source> pixels/mm</source>
        <translation> Pixel/mm</translation>
    </message>
    <message>
        <source>How large a place must have been on screen to count as seen</source>
        <translation>Wie groß eine Stelle auf dem Schirm gewesen sein muss, um als gesehen zu gelten</translation>
    </message>
    <message>
        <source> ms</source>
        <translation> ms</translation>
    </message>
    <message>
        <source>How long a place must have been on screen to count as seen</source>
        <translation>Wie lange eine Stelle auf dem Schirm gewesen sein muss, um als gesehen zu gelten</translation>
    </message>
    <message>
        <source>A place counts as seen that has been on screen so large, for so long in all. Each choice has a record of its own.</source>
        <translation>Als gesehen gilt eine Stelle, die so groß und insgesamt so lange auf dem Schirm war. Über jede Wahl wird eigens Buch geführt.</translation>
    </message>
    <message>
        <source>Missed patches of the wall, the largest first</source>
        <translation>Übersehene Stellen der Wand, die größten zuerst</translation>
    </message>
    <message>
        <source>mm²</source>
        <translation>mm²</translation>
    </message>
    <message>
        <source>mm from the rectum</source>
        <translation>mm vom Rektum</translation>
    </message>
    <message>
        <source>Seen from</source>
        <translation>Gesehen ab</translation>
    </message>
    <message>
        <source>No patch of 300 mm² or more has been missed.</source>
        <translation>Keine Stelle ab 300 mm² wurde übersehen.</translation>
    </message>
    <message>
        <source>No earlier patch is still missed.</source>
        <translation>Keine frühere Stelle ist noch übersehen.</translation>
    </message>
    <message>
        <source>%1 % of the wall seen</source>
        <translation>%1 % der Wand gesehen</translation>
    </message>
    <message>
        <source>asking…</source>
        <translation>wird gefragt …</translation>
    </message>
    <message numerus="yes">
        <source>%n patch(es) of 300 mm² or more missed, %1 cm² together</source>
        <translation>
            <numerusform>%n übersehene Stelle ab 300 mm², %1 cm²</numerusform>
            <numerusform>%n übersehene Stellen ab 300 mm², zusammen %1 cm²</numerusform>
        </translation>
    </message>
    <message>
        <source>It is not kept: with this session it is forgotten.</source>
        <translation>Es wird nicht behalten: mit dieser Sitzung ist es vergessen.</translation>
    </message>
    <message>
        <source>Save a report of what has been seen</source>
        <translation>Bericht über das Gesehene speichern</translation>
    </message>
    <message>
        <source>Reports (*.json)</source>
        <translation>Berichte (*.json)</translation>
    </message>
    <message>
        <source>No report was saved.</source>
        <translation>Es wurde kein Bericht gespeichert.</translation>
    </message>
    <message>
        <source>Report saved: %1</source>
        <translation>Bericht gespeichert: %1</translation>
    </message>
    <message>
        <source>cannot write %1: %2</source>
        <translation>%1 kann nicht geschrieben werden: %2</translation>
    </message>
</context>
<context>
    <name>haustra::window::Notices</name>
    <message>
        <source>Dismiss this notice</source>
        <translation>Diesen Hinweis schließen</translation>
    </message>
    <message>
        <source>The link is down: %1. Trying again; the flight stands still.</source>
        <translation>Die Verbindung ist unterbrochen: %1. Neuer Versuch läuft; der Flug steht still.</translation>
    </message>
    <message numerus="yes">
        <source>%n bookmark(s) will be saved when the server is back.</source>
        <translation>
            <numerusform>%n Lesezeichen wird gespeichert, sobald der Server wieder erreichbar ist.</numerusform>
            <numerusform>%n Lesezeichen werden gespeichert, sobald der Server wieder erreichbar ist.</numerusform>
        </translation>
    </message>
    <message>
        <source>The server has owed a picture or an answer for %1 s.</source>
        <translation>Der Server schuldet seit %1 s ein Bild oder eine Antwort.</translation>
    </message>
    <message>
        <source>The server opens the case. What is shown is old until then.</source>
        <translation>Der Server öffnet den Fall. Bis dahin ist das Gezeigte veraltet.</translation>
    </message>
    <message>
        <source>The session has ended: %1. “Connect again” in the menu of files begins another.</source>
        <translation>Die Sitzung ist zu Ende: %1. „Neu verbinden“ im Menü „Datei“ beginnt eine andere.</translation>
    </message>
</context>
<context>
    <name>haustra::window::ObliquePane</name>
    <message>
        <source>Across the gaze</source>
        <translation>Quer zum Blick</translation>
    </message>
    <message>
        <source>%1 mm ahead</source>
        <translation>%1 mm voraus</translation>
    </message>
    <message>
        <source>%1 mm behind</source>
        <translation>%1 mm zurück</translation>
    </message>
    <message>
        <source>go to a voxel</source>
        <translation>zu einem Voxel gehen</translation>
    </message>
    <message>
        <source>In the middle again</source>
        <translation>Wieder in die Mitte</translation>
    </message>
</context>
<context>
    <name>haustra::window::OpticsPanel</name>
    <message>
        <source>Reach</source>
        <translation>Reichweite</translation>
    </message>
    <message>
        <source>Where the lamp&apos;s light has fallen to a half, mm</source>
        <translation>Entfernung, in der das Licht der Lampe auf die Hälfte abgefallen ist, mm</translation>
    </message>
    <message>
        <source>Ambient</source>
        <translation>Umgebung</translation>
    </message>
    <message>
        <source>Light from everywhere</source>
        <translation>Licht von allen Seiten</translation>
    </message>
    <message>
        <source>Diffuse</source>
        <translation>Diffus</translation>
    </message>
    <message>
        <source>What faces the lamp is brighter</source>
        <translation>Was der Lampe zugewandt ist, ist heller</translation>
    </message>
    <message>
        <source>Gloss</source>
        <translation>Glanz</translation>
    </message>
    <message>
        <source>Highlights, as of a moist wall</source>
        <translation>Glanzlichter wie auf einer feuchten Wand</translation>
    </message>
    <message>
        <source>Sharpness</source>
        <translation>Schärfe</translation>
    </message>
    <message>
        <source>How small highlights are</source>
        <translation>Wie klein die Glanzlichter sind</translation>
    </message>
    <message>
        <source>Preset of the wall&apos;s optics</source>
        <translation>Vorlage für die Optik der Wand</translation>
    </message>
    <message>
        <source>Back to the preset</source>
        <translation>Zurück zur Vorlage</translation>
    </message>
    <message>
        <source>Fit</source>
        <translation>Einpassen</translation>
    </message>
    <message>
        <source>The axis as wide as the points</source>
        <translation>Die Achse so breit wie die Punkte</translation>
    </message>
    <message>
        <source>choose a preset</source>
        <translation>Vorlage wählen</translation>
    </message>
    <message>
        <source>back to the preset</source>
        <translation>zurück zur Vorlage</translation>
    </message>
    <message>
        <source>Gradient magnitude</source>
        <translation>Gradientenbetrag</translation>
    </message>
    <message>
        <source>HU per mm: how quickly the scan&apos;s values change there</source>
        <translation>HU pro mm: wie schnell sich die CT-Werte dort ändern</translation>
    </message>
    <message>
        <source>Add a row by gradient magnitude</source>
        <translation>Zeile nach Gradientenbetrag hinzufügen</translation>
    </message>
    <message>
        <source>Other colours where the gradient is greater: a row more</source>
        <translation>Andere Farben, wo der Gradient größer ist: eine weitere Zeile</translation>
    </message>
    <message>
        <source>Remove this row</source>
        <translation>Diese Zeile entfernen</translation>
    </message>
    <message>
        <source>Take this row away</source>
        <translation>Diese Zeile entfernen</translation>
    </message>
    <message>
        <source>From which gradient magnitude on, HU per mm</source>
        <translation>Ab welchem Gradientenbetrag, HU pro mm</translation>
    </message>
    <message>
        <source> HU/mm</source>
        <translation> HU/mm</translation>
    </message>
    <message>
        <source>add a row</source>
        <translation>Zeile hinzufügen</translation>
    </message>
    <message>
        <source>There is no room for another row.</source>
        <translation>Für eine weitere Zeile ist kein Platz.</translation>
    </message>
    <message>
        <source>remove a row</source>
        <translation>Zeile entfernen</translation>
    </message>
    <message>
        <source>move a row</source>
        <translation>Zeile verschieben</translation>
    </message>
    <message>
        <source>Drag a point. Double click adds one, right click takes one. The wheel enlarges, a drag beside the points moves the axis.</source>
        <translation>Einen Punkt ziehen. Doppelklick fügt einen hinzu, Rechtsklick entfernt einen. Das Mausrad vergrößert, Ziehen neben den Punkten verschiebt die Achse.</translation>
    </message>
    <message>
        <source>Colour of the point</source>
        <translation>Farbe des Punktes</translation>
    </message>
    <message>
        <source>Colour</source>
        <translation>Farbe</translation>
    </message>
    <message>
        <source>Value of the point, HU</source>
        <translation>Wert des Punktes, HU</translation>
    </message>
    <message>
        <source> HU</source>
        <translation> HU</translation>
    </message>
    <message>
        <source>Opacity of a millimetre</source>
        <translation>Deckkraft eines Millimeters</translation>
    </message>
    <message>
        <source>opacity </source>
        <translation>Deckkraft </translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>Remove the point</source>
        <translation>Punkt entfernen</translation>
    </message>
    <message>
        <source>remove a point</source>
        <translation>Punkt entfernen</translation>
    </message>
    <message>
        <source>emission and absorption</source>
        <translation>Emission und Absorption</translation>
    </message>
    <message>
        <source>maximum intensity</source>
        <translation>maximale Intensität</translation>
    </message>
    <message>
        <source>first hit</source>
        <translation>erster Treffer</translation>
    </message>
    <message>
        <source>Composition</source>
        <translation>Komposition</translation>
    </message>
    <message>
        <source>What a ray makes of its samples: all of them front to back, the greatest, or the first that is half opaque</source>
        <translation>Was ein Strahl aus seinen Abtastwerten macht: alle von vorn nach hinten, den größten oder den ersten, der halb deckend ist</translation>
    </message>
    <message>
        <source>pre-integrated</source>
        <translation>vorintegriert</translation>
    </message>
    <message>
        <source>Smooth where opacity changes quickly; not with rows by gradient magnitude</source>
        <translation>Glatt, wo sich die Deckkraft schnell ändert; nicht mit Zeilen nach Gradientenbetrag</translation>
    </message>
    <message>
        <source>lit</source>
        <translation>beleuchtet</translation>
    </message>
    <message>
        <source>choose the composition</source>
        <translation>Komposition wählen</translation>
    </message>
    <message>
        <source>pre-integration</source>
        <translation>Vorintegration</translation>
    </message>
    <message>
        <source>shading</source>
        <translation>Beleuchtung</translation>
    </message>
    <message>
        <source>change the light</source>
        <translation>Licht ändern</translation>
    </message>
    <message>
        <source>Save as a file…</source>
        <translation>Als Datei speichern…</translation>
    </message>
    <message>
        <source>For haustra render --tf, or a server&apos;s --presets folder</source>
        <translation>Für haustra render --tf oder den Ordner --presets eines Servers</translation>
    </message>
    <message>
        <source>Open…</source>
        <translation>Öffnen…</translation>
    </message>
    <message>
        <source>Open a preset&apos;s file</source>
        <translation>Datei einer Vorlage öffnen</translation>
    </message>
    <message>
        <source>any</source>
        <translation>jeder</translation>
    </message>
    <message>
        <source>Row from %1 HU per mm</source>
        <translation>Zeile ab %1 HU pro mm</translation>
    </message>
    <message>
        <source>move a point</source>
        <translation>Punkt verschieben</translation>
    </message>
    <message>
        <source>colour a point</source>
        <translation>Punkt einfärben</translation>
    </message>
    <message>
        <source>Save the optics as a preset</source>
        <translation>Optik als Vorlage speichern</translation>
    </message>
    <message>
        <source>Presets (*.json)</source>
        <translation>Vorlagen (*.json)</translation>
    </message>
    <message>
        <source>Saved %1</source>
        <translation>Gespeichert: %1</translation>
    </message>
    <message>
        <source>Open a preset</source>
        <translation>Vorlage öffnen</translation>
    </message>
</context>
<context>
    <name>haustra::window::OverviewPane</name>
    <message>
        <source>Overview</source>
        <translation>Übersicht</translation>
    </message>
    <message>
        <source>From the front</source>
        <translation>Von vorn</translation>
    </message>
    <message>
        <source>go to a bookmark</source>
        <translation>zu einem Lesezeichen gehen</translation>
    </message>
    <message>
        <source>go along the path</source>
        <translation>auf dem Pfad gehen</translation>
    </message>
    <message>
        <source>Bookmark</source>
        <translation>Lesezeichen</translation>
    </message>
</context>
<context>
    <name>haustra::window::Pane</name>
    <message>
        <source>waiting for the picture</source>
        <translation>wartet auf das Bild</translation>
    </message>
    <message>
        <source>old: the link is down</source>
        <translation>veraltet: keine Verbindung</translation>
    </message>
    <message>
        <source>exact</source>
        <translation>exakt</translation>
    </message>
    <message>
        <source>moving</source>
        <translation>bewegt</translation>
    </message>
    <message>
        <source>waiting for the picture…</source>
        <translation>Warten auf das Bild…</translation>
    </message>
    <message>
        <source>Case: %1</source>
        <translation>Fall: %1</translation>
    </message>
    <message>
        <source>View: %1 (%2)</source>
        <translation>Ansicht: %1 (%2)</translation>
    </message>
    <message>
        <source>Place: %1 mm of %2 mm along the path</source>
        <translation>Stelle: %1 mm von %2 mm auf dem Pfad</translation>
    </message>
    <message>
        <source>Server: %1, %2</source>
        <translation>Server: %1, %2</translation>
    </message>
    <message>
        <source>Taken: %1</source>
        <translation>Bild erstellt: %1</translation>
    </message>
    <message>
        <source>For a physician&apos;s judgement; not a certified medical device.</source>
        <translation>Zur ärztlichen Beurteilung; kein zertifiziertes Medizinprodukt.</translation>
    </message>
    <message>
        <source>old picture</source>
        <translation>veraltetes Bild</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>finding %1: %2</source>
        <translation>Befund %1: %2</translation>
    </message>
</context>
<context>
    <name>haustra::window::PathTrack</name>
    <message>
        <source>Place along the colon, millimetres from the rectum</source>
        <translation>Stelle im Kolon, Millimeter ab dem Rektum</translation>
    </message>
    <message>
        <source>go along the path</source>
        <translation>auf dem Pfad gehen</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
</context>
<context>
    <name>haustra::window::ReaderWindow</name>
    <message>
        <source>Haustra, second window</source>
        <translation>Haustra, zweites Fenster</translation>
    </message>
    <message>
        <source>Bookmarks</source>
        <translation>Lesezeichen</translation>
    </message>
    <message>
        <source>Colours, opacities and light</source>
        <translation>Farben, Deckkraft und Licht</translation>
    </message>
    <message>
        <source>Saved layouts</source>
        <translation>Gespeicherte Layouts</translation>
    </message>
    <message>
        <source>Panes</source>
        <translation>Bereiche</translation>
    </message>
    <message>
        <source>Theme</source>
        <translation>Farbschema</translation>
    </message>
    <message>
        <source>Dark</source>
        <translation>Dunkel</translation>
    </message>
    <message>
        <source>Light</source>
        <translation>Hell</translation>
    </message>
    <message>
        <source>High contrast</source>
        <translation>Hoher Kontrast</translation>
    </message>
    <message>
        <source>Language</source>
        <translation>Sprache</translation>
    </message>
    <message>
        <source>The language changes with the next start.</source>
        <translation>Die Sprache wechselt mit dem nächsten Start.</translation>
    </message>
    <message>
        <source>not cleansed</source>
        <translation>nicht gereinigt</translation>
    </message>
    <message>
        <source>Figures of the link and the pictures</source>
        <translation>Werte der Verbindung und der Bilder</translation>
    </message>
    <message>
        <source>Server</source>
        <translation>Server</translation>
    </message>
    <message>
        <source>Save this layout</source>
        <translation>Dieses Layout speichern</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>The layout “%1” is saved.</source>
        <translation>Das Layout „%1“ ist gespeichert.</translation>
    </message>
    <message>
        <source>The layout “%1” cannot be read.</source>
        <translation>Das Layout „%1“ kann nicht gelesen werden.</translation>
    </message>
    <message>
        <source>none yet</source>
        <translation>noch keines</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>The picture of “%1” is copied.</source>
        <translation>Das Bild von „%1“ ist kopiert.</translation>
    </message>
    <message>
        <source>Go to a place along the path</source>
        <translation>Zu einer Stelle auf dem Pfad gehen</translation>
    </message>
    <message>
        <source>mm from the rectum (up to %1)</source>
        <translation>mm ab dem Rektum (bis %1)</translation>
    </message>
    <message>
        <source>go along the path</source>
        <translation>auf dem Pfad gehen</translation>
    </message>
    <message>
        <source>This case has no cleansed scan.</source>
        <translation type="vanished">Für diesen Fall gibt es keine gereinigten CT-Daten.</translation>
    </message>
    <message>
        <source>This server cannot show slabs.</source>
        <translation type="vanished">Dieser Server kann keine Schichtpakete zeigen.</translation>
    </message>
    <message>
        <source>%1: no link</source>
        <translation>%1: keine Verbindung</translation>
    </message>
    <message>
        <source>colon %1 % sure</source>
        <translation>Kolon %1 % sicher</translation>
    </message>
    <message numerus="yes">
        <source>%n place(s) to look at</source>
        <translation>
            <numerusform>%n Stelle zu prüfen</numerusform>
            <numerusform>%n Stellen zu prüfen</numerusform>
        </translation>
    </message>
    <message>
        <source>wall seen %1 %</source>
        <translation>Wand gesehen %1 %</translation>
    </message>
    <message>
        <source>wall seen –</source>
        <translation>Wand gesehen –</translation>
    </message>
    <message>
        <source>%1 pictures/s</source>
        <translation>%1 Bilder/s</translation>
    </message>
    <message>
        <source>hand to picture %1 ms, p95 %2</source>
        <translation>Hand bis Bild %1 ms, p95 %2</translation>
    </message>
    <message>
        <source>link %1 ms</source>
        <translation>Verbindung %1 ms</translation>
    </message>
    <message>
        <source>Place along the colon</source>
        <translation>Stelle im Kolon</translation>
    </message>
    <message>
        <source>rectum</source>
        <translation>Rektum</translation>
    </message>
    <message>
        <source>cecum</source>
        <translation>Zökum</translation>
    </message>
    <message>
        <source>Menus</source>
        <translation>Menüs</translation>
    </message>
    <message>
        <source>Bookmarks are not sent yet</source>
        <translation>Lesezeichen sind noch nicht gesendet</translation>
    </message>
    <message numerus="yes">
        <source>%n bookmark(s) wait for the server. They are kept on this station, and sent when the case is opened here again. Quit?</source>
        <translation>
            <numerusform>%n Lesezeichen wartet auf den Server. Es bleibt auf dieser Station und wird gesendet, wenn der Fall hier wieder geöffnet wird. Beenden?</numerusform>
            <numerusform>%n Lesezeichen warten auf den Server. Sie bleiben auf dieser Station und werden gesendet, wenn der Fall hier wieder geöffnet wird. Beenden?</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n bookmark(s) wait for the server, and this station cannot keep them: they are lost with this window. Quit all the same?</source>
        <translation>
            <numerusform>%n Lesezeichen wartet auf den Server, und diese Station kann es nicht aufbewahren: Es geht mit diesem Fenster verloren. Trotzdem beenden?</numerusform>
            <numerusform>%n Lesezeichen warten auf den Server, und diese Station kann sie nicht aufbewahren: Sie gehen mit diesem Fenster verloren. Trotzdem beenden?</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n bookmark(s) wait for the server, and this station cannot keep them: they are lost with this session. Connect again all the same?</source>
        <translation>
            <numerusform>%n Lesezeichen wartet auf den Server, und diese Station kann es nicht aufbewahren: Es geht mit dieser Sitzung verloren. Trotzdem neu verbinden?</numerusform>
            <numerusform>%n Lesezeichen warten auf den Server, und diese Station kann sie nicht aufbewahren: Sie gehen mit dieser Sitzung verloren. Trotzdem neu verbinden?</numerusform>
        </translation>
    </message>
    <message>
        <source>Findings</source>
        <translation>Befunde</translation>
    </message>
    <message>
        <source>Seen and missed</source>
        <translation>Gesehen und übersehen</translation>
    </message>
    <message>
        <source>wall seen %1 %, not kept</source>
        <translation>Wand gesehen %1 %, nicht behalten</translation>
    </message>
    <message>
        <source>supine</source>
        <translation>Rückenlage</translation>
    </message>
    <message>
        <source>prone</source>
        <translation>Bauchlage</translation>
    </message>
    <message>
        <source>on the left side</source>
        <translation>Linksseitenlage</translation>
    </message>
    <message>
        <source>on the right side</source>
        <translation>Rechtsseitenlage</translation>
    </message>
    <message>
        <source>More</source>
        <translation>Mehr</translation>
    </message>
</context>
<context>
    <name>haustra::window::Reading</name>
    <message>
        <source>First meeting with this server: its certificate is now pinned (%1…)</source>
        <translation>Erster Kontakt mit diesem Server: Sein Zertifikat ist jetzt hinterlegt (%1…)</translation>
    </message>
    <message numerus="yes">
        <source>%n bookmark(s) saved</source>
        <translation>
            <numerusform>%n Lesezeichen gespeichert</numerusform>
            <numerusform>%n Lesezeichen gespeichert</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n bookmark(s) not saved: the server refused. They are kept in the list of bookmarks, to be sent again or discarded.</source>
        <translation>
            <numerusform>%n Lesezeichen nicht gespeichert: Der Server hat es abgelehnt. Es bleibt in der Liste der Lesezeichen und kann erneut gesendet oder verworfen werden.</numerusform>
            <numerusform>%n Lesezeichen nicht gespeichert: Der Server hat sie abgelehnt. Sie bleiben in der Liste der Lesezeichen und können erneut gesendet oder verworfen werden.</numerusform>
        </translation>
    </message>
    <message>
        <source>The server counts what has been seen of the wall anew with this link.</source>
        <translation>Der Server zählt mit dieser Verbindung neu, was von der Wand gesehen wurde.</translation>
    </message>
    <message>
        <source>clear measurements</source>
        <translation>Messungen löschen</translation>
    </message>
    <message>
        <source>measure between two places</source>
        <translation>zwischen zwei Orten messen</translation>
    </message>
</context>
<context>
    <name>haustra::window::SlicePane</name>
    <message>
        <source>%1 %2 mm</source>
        <translation>%1 %2 mm</translation>
    </message>
    <message>
        <source>Whole slice</source>
        <translation>Ganze Schicht</translation>
    </message>
    <message>
        <source>×%1</source>
        <translation>×%1</translation>
    </message>
    <message>
        <source>not linked</source>
        <translation>nicht gekoppelt</translation>
    </message>
    <message>
        <source>go to a voxel</source>
        <translation>zu einem Voxel gehen</translation>
    </message>
    <message>
        <source>Coronal</source>
        <translation>Koronal</translation>
    </message>
    <message>
        <source>Sagittal</source>
        <translation>Sagittal</translation>
    </message>
    <message>
        <source>Axial</source>
        <translation>Axial</translation>
    </message>
</context>
<context>
    <name>haustra::window::StripPane</name>
    <message>
        <source>bridge %1 mm</source>
        <translation>Brücke %1 mm</translation>
    </message>
    <message>
        <source>Flattened colon</source>
        <translation>Abgewickeltes Kolon</translation>
    </message>
    <message>
        <source>rectum</source>
        <translation>Rektum</translation>
    </message>
    <message>
        <source>cecum</source>
        <translation>Zökum</translation>
    </message>
    <message>
        <source>go along the flattened colon</source>
        <translation>entlang des abgewickelten Kolons gehen</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
</context>
<context>
    <name>haustra::window::TransferGraph</name>
    <message>
        <source>Transfer function: opacity and colour over the scan&apos;s values</source>
        <translation>Übertragungsfunktion: Deckkraft und Farbe über den CT-Werten</translation>
    </message>
    <message>
        <source>change the transfer function</source>
        <translation>Übertragungsfunktion ändern</translation>
    </message>
</context>
</TS>
