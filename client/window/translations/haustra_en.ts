<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="en" sourcelanguage="en">
<context>
    <name>haustra::window::CaseList</name>
    <message numerus="yes">
        <source>%n place(s) to look at</source>
        <translation>
            <numerusform>%n place to look at</numerusform>
            <numerusform>%n places to look at</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n case(s) on %1</source>
        <translation>
            <numerusform>%n case on %1</numerusform>
            <numerusform>%n cases on %1</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n reader(s)</source>
        <translation>
            <numerusform>%n reader</numerusform>
            <numerusform>%n readers</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>haustra::window::FindingsPanel</name>
    <message numerus="yes">
        <source>%n place(s) to judge</source>
        <translation>
            <numerusform>%n place to judge</numerusform>
            <numerusform>%n places to judge</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>haustra::window::MissedPanel</name>
    <message numerus="yes">
        <source>%n patch(es) of 300 mm² or more missed, %1 cm² together</source>
        <translation>
            <numerusform>%n patch of 300 mm² or more missed, %1 cm²</numerusform>
            <numerusform>%n patches of 300 mm² or more missed, %1 cm² together</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>haustra::window::Notices</name>
    <message numerus="yes">
        <source>%n bookmark(s) will be saved when the server is back.</source>
        <translation>
            <numerusform>%n bookmark will be saved when the server is back.</numerusform>
            <numerusform>%n bookmarks will be saved when the server is back.</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>haustra::window::ReaderWindow</name>
    <message numerus="yes">
        <source>%n place(s) to look at</source>
        <translation>
            <numerusform>%n place to look at</numerusform>
            <numerusform>%n places to look at</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n bookmark(s) wait for the server. They are kept on this station, and sent when the case is opened here again. Quit?</source>
        <translation>
            <numerusform>%n bookmark waits for the server. It is kept on this station, and sent when the case is opened here again. Quit?</numerusform>
            <numerusform>%n bookmarks wait for the server. They are kept on this station, and sent when the case is opened here again. Quit?</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n bookmark(s) wait for the server, and this station cannot keep them: they are lost with this window. Quit all the same?</source>
        <translation>
            <numerusform>%n bookmark waits for the server, and this station cannot keep it: it is lost with this window. Quit all the same?</numerusform>
            <numerusform>%n bookmarks wait for the server, and this station cannot keep them: they are lost with this window. Quit all the same?</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n bookmark(s) wait for the server, and this station cannot keep them: they are lost with this session. Connect again all the same?</source>
        <translation>
            <numerusform>%n bookmark waits for the server, and this station cannot keep it: it is lost with this session. Connect again all the same?</numerusform>
            <numerusform>%n bookmarks wait for the server, and this station cannot keep them: they are lost with this session. Connect again all the same?</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>haustra::window::Reading</name>
    <message numerus="yes">
        <source>%n bookmark(s) saved</source>
        <translation>
            <numerusform>%n bookmark saved</numerusform>
            <numerusform>%n bookmarks saved</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n bookmark(s) not saved: the server refused. They are kept in the list of bookmarks, to be sent again or discarded.</source>
        <translation>
            <numerusform>%n bookmark not saved: the server refused. It is kept in the list of bookmarks, to be sent again or discarded.</numerusform>
            <numerusform>%n bookmarks not saved: the server refused. They are kept in the list of bookmarks, to be sent again or discarded.</numerusform>
        </translation>
    </message>
</context>
</TS>
